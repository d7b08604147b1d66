// Pictures as programs without OpenEXR open them: PNG, JPEG, TIFF and whatever else OpenImageIO writes.
#pragma once

#include "../../base/image.h"

#include <string>

namespace sparselens {

// Whether the name ends like that of a format other than OpenEXR that OpenImageIO can write.
bool is_shown_picture(const std::string &path);

// R, G, B (values as the screen shows them, premultiplied) of the display window; where the data window leaves it
// uncovered, black. 8 bits, in TIFF and DPX 16. Where A is below 1 somewhere, and the format has alpha, it is written
// too, and the colours unpremultiplied. Appears whole or not at all, as all outputs (see OutputFile).
// Error: no R, G, B, or what OpenImageIO refuses, naming the file.
void write_shown_picture(const std::string &path, const Image &image);

} // namespace sparselens
