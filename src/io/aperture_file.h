// A picture of an aperture from an EXR file.
#pragma once

#include "../lens/aperture_shape.h"

#include <memory>
#include <string>

namespace sparselens {

// Reads R, G and B; if they are missing, Y; otherwise the only channel besides A. Alpha is ignored. A picture of more
// than 2048 pixels a side is averaged down, because the gather needs up to 100 bytes for each of its pixels. Throws
// Error, naming the file, if it cannot be read, has no such channels, or has values that are negative, not finite, or
// all black.
std::shared_ptr<const AperturePicture> read_aperture_picture(const std::string &path);

} // namespace sparselens
