// Colours stored as luminance and chroma: the channels Y, RY and BY, of which the last two have a quarter of the pixels
// ("Technical Introduction to OpenEXR", luminance/chroma images). Not for use outside io/.
#pragma once

#include "base/image.h"
#include "io/files/file_stream.h"

#include <ImfHeader.h>

#include <string_view>

namespace sparselens {

// Whether the part holds its colours so: Y, RY and BY, and no R, G or B.
bool is_luminance_chroma(const Imf::Header &header);

// Whether a channel of such a part is one of the three, by its name in the file.
bool is_luminance_or_chroma(std::string_view channel);

// Reads R, G and B of the first part of a file into the channels of these names, over the data window of that part.
// OpenEXR interpolates the missing chroma, and makes colours by the chromaticities of the header.
void read_luminance_chroma(InputStream &stream, Image &image);

} // namespace sparselens
