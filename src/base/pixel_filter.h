// What a pixel of a picture shows of what lies around it, and how that is made of sub-pixels: of a picture rendered at several
// times the size, of which blocks of sub-pixels become one pixel each.
//
// Renderers filter pixels wider than the square that they are. A view at N times the size is filtered by the same number of its
// own pixels, which is 1/N of the width in the picture. What is missing is a filter of what variances say: that of the whole
// filter, less that of the views' own, and less what the gather adds.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens {

struct PixelFilter {
    enum class Shape { box, blackman_harris, gaussian } shape = Shape::box;
    double width =
        1.5; // pixels, (0, 16]; as Cycles' setting of that name. A box has none: it is one pixel wide
    bool operator==(const PixelFilter &) const = default;
};

// From "box", "blackman-harris" or "gaussian", the latter two with ":WIDTH" behind if wanted, and back. Empty if it is none of them.
std::optional<PixelFilter> pixel_filter_of(std::string_view text);
std::string text_of(const PixelFilter &filter);

// How many sub-pixels, across and down, become one pixel, and how.
struct Subpixels {
    int across = 1; // [1, most_across]
    PixelFilter filter = {};
    bool operator==(const Subpixels &) const = default;
};
inline constexpr int most_across = 16;

// The shares in a pixel, across or down, of its sub-pixels and of those on both sides beside them: of across + 2 m, they add up
// to 1 and are symmetric. For a box they are 1 / across each.
std::vector<double> subpixel_shares(const Subpixels &by);

} // namespace sparselens
