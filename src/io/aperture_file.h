// A picture of an aperture from an EXR file.
#pragma once

#include "../lens/aperture_shape.h"

#include <memory>
#include <string>

namespace sparselens {

// Its R, G and B; else Y, else the only channel but for A. Alpha is ignored. A picture of more than 2048 pixels a side is
// averaged down to fewer: what is made of it takes up to 100 bytes a pixel, whatever memory its file may ask for. Throws Error, naming the file, where it cannot
// be read, has no such channels, or values that are negative, not finite, or all black.
std::shared_ptr<const AperturePicture> read_aperture_picture(const std::string &path);

} // namespace sparselens
