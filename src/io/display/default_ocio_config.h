// share/ocio/config.ocio, carried within the library.
#pragma once

namespace sparselens {

const char *default_ocio_config();

} // namespace sparselens
