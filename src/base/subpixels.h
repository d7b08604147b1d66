// Makes a picture from sub-pixels.
//
// Light, and the coverage of each Cryptomatte id, is the mean of the sub-pixels, weighted by the pixel's filter.
// Ids and data have no mean and come from the sub-pixel in the middle.
#pragma once

#include "image.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens {

// The filter of a picture's pixels, and how it is made from sub-pixels. Sub-pixels are the pixels of a picture rendered
// at several times the size; a block of them becomes one pixel.
//
// Renderers filter over more than the square of a pixel. A view at N times the size is filtered over the same number of
// its own pixels, which is 1/N of the width in the picture. The missing filter follows from variances: the variance of
// the whole filter, minus the variance of the views' filter, minus the variance that the gather adds.
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

// The pixels that contain the sub-pixels of `box` if `across` of them, across and down, become one pixel.
Imath::Box2i reduced(const Imath::Box2i &box, int across);

// The sub-pixels of the pixels of a box.
Imath::Box2i subpixels_in(const Imath::Box2i &box, int across);

// The same, and the sub-pixels around them that the pixel's filter reaches.
Imath::Box2i subpixels_under(const Imath::Box2i &box, const Subpixels &by);

// The sub-pixel in the middle of a pixel; right of and below the middle if their number is even. If the result would
// overflow, it is the outermost coordinate, where no picture is.
Imath::V2i middle_subpixel(const Imath::V2i &pixel, int across);

// The pixels whose filter reaches a sub-pixel of `box`.
Imath::Box2i pixels_reached(const Imath::Box2i &box, const Subpixels &by);

// The pixels `box` of the picture. Sub-pixels that `fine` lacks are empty inside its display window, with data of
// `nothing`. Outside of it they are unknown and are left out of the mean. Sums are in double, so a constant stays
// constant up to float rounding.
Image mean_of_subpixels(const Image &fine, const Subpixels &by, const Imath::Box2i &box, float nothing = 0);

} // namespace sparselens
