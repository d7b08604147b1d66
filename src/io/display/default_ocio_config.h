// The text of share/ocio/config.ocio, compiled into the library.
#pragma once

namespace sparselens {

const char *default_ocio_config();

} // namespace sparselens
