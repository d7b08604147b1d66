// Colours stored as luminance and chroma: the channels Y, RY and BY, of which the last two have a quarter of the pixels
// ("Technical Introduction to OpenEXR", luminance/chroma images). OpenEXR's own reader for them is not used, because it
// takes no error handler (exr_common.h) and reads only the first part. Not for use outside io/.
#pragma once

#include "base/grid.h"

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfRgba.h>

#include <array>
#include <span>
#include <string_view>
#include <vector>

namespace sparselens {

// Whether the part stores its colours in this way: Y, RY and BY, and no R, G or B.
bool is_luminance_chroma(const Imf::Header &header);

// Whether a channel of such a part is Y, RY or BY, by its name in the file.
bool is_luminance_or_chroma(std::string_view channel);

// The colours of such a part. Memory: 8 bytes per pixel of its data window.
class LuminanceChroma {
public:
    explicit LuminanceChroma(const Imf::Header &header);

    // Adds the slices into which the three channels are read.
    void insert_into(Imf::FrameBuffer &buffer);

    // Converts the channels to colours, row by row into the planes of R, G and B. `to` is the grid of the planes and
    // contains the part. The missing chroma is interpolated by OpenEXR's filters; the header's chromaticities define
    // luminance.
    void write(const std::array<std::span<float>, 3> &planes, const Grid &to);

private:
    // R, G and B of a row, which may be one row outside.
    void row(int y, std::vector<Imf::Rgba> &colours) const;

    Grid grid_;
    Imath::V3f weights_; // of R, G and B in the luminance
    // Luminance in g; chroma in r and b, first in even columns of even rows, then in all columns of even rows.
    std::vector<Imf::Rgba> pixels_;
};

} // namespace sparselens
