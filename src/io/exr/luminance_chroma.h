// Colours stored as luminance and chroma: the channels Y, RY and BY, of which the last two have a quarter of the pixels
// ("Technical Introduction to OpenEXR", luminance/chroma images). OpenEXR's own reader of them is not used, as it takes no handler
// of errors (open_exr.h) and reads the first part alone. Not for use outside io/.
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

// Whether the part holds its colours so: Y, RY and BY, and no R, G or B.
bool is_luminance_chroma(const Imf::Header &header);

// Whether a channel of such a part is one of the three, by its name in the file.
bool is_luminance_or_chroma(std::string_view channel);

// The colours of such a part. Memory: 8 bytes per pixel of its data window.
class LuminanceChroma {
public:
    explicit LuminanceChroma(const Imf::Header &header);

    // Adds what the three channels are to be read into.
    void insert_into(Imf::FrameBuffer &buffer);

    // Makes colours of what was read, row by row into the planes of R, G and B, whose pixels `to` counts and which contain the
    // part's. The missing chroma is interpolated by OpenEXR's filters, and the header's chromaticities say what luminance is.
    void write(const std::array<std::span<float>, 3> &planes, const Grid &to);

private:
    // R, G and B of a row, which may lie one row outside.
    void row(int y, std::vector<Imf::Rgba> &colours) const;

    Grid grid_;
    Imath::V3f weights_; // of R, G and B in the luminance
    // Luminance in g; chroma in r and b, of even columns in even rows, and then of all columns in even rows.
    std::vector<Imf::Rgba> pixels_;
};

} // namespace sparselens
