// The page of dof-view: the files of viewing/page, compiled in (cmake/Embed.cmake).
#pragma once

namespace sparselens {

extern const char *const page_body;
extern const char *const page_style;
extern const char *const page_script;

} // namespace sparselens
