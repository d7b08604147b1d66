// The filter of a picture's pixels, and how it is made from sub-pixels. Sub-pixels are the pixels of a picture rendered
// at several times the size; a block of them becomes one pixel.
//
// Renderers filter over more than the square of a pixel. A view at N times the size is filtered over the same number of
// its own pixels, which is 1/N of the width in the picture. The missing filter follows from variances: the variance of
// the whole filter, minus the variance of the views' filter, minus the variance that the gather adds.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens {

struct PixelFilter {
    enum class Shape { box, blackman_harris, gaussian } shape = Shape::box;
    double width = 1.5; // pixels, (0, 16]; as in Cycles. A box ignores it: it is one pixel wide
    bool operator==(const PixelFilter &) const = default;
};

// Reads "box", "blackman-harris" or "gaussian", the latter two with an optional ":WIDTH"; empty for any other text.
std::optional<PixelFilter> pixel_filter_of(std::string_view text);
std::string text_of(const PixelFilter &filter);

// How many sub-pixels, across and down, become one pixel, and how.
struct Subpixels {
    int across = 1; // [1, most_across]
    PixelFilter filter = {};
    bool operator==(const Subpixels &) const = default;
};
inline constexpr int most_across = 16;

// The weights of sub-pixels in a pixel, across or down: its own ones and m more on each side, across + 2 m in all. They
// are symmetric and sum to 1. For a box each is 1 / across.
std::vector<double> subpixel_shares(const Subpixels &by);

} // namespace sparselens
