// The style and the script of the page: page.css and page.js, compiled in.
#pragma once

namespace sparselens::lab {

extern const char *const page_style;
extern const char *const page_script;

} // namespace sparselens::lab
