#include "base/pixel_filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace sparselens {

namespace {

using Shape = PixelFilter::Shape;
constexpr std::array<std::pair<std::string_view, Shape>, 3> shapes{
    {{"box", Shape::box}, {"blackman-harris", Shape::blackman_harris}, {"gaussian", Shape::gaussian}}};

constexpr double widest = 16; // pixels

// The variance that the gather adds, in square sub-pixels: samples are squares, seen from all of a pixel, 1/12 each.
// Sharpening takes some of it back near the focus. Measured on the path-traced yard.
constexpr double of_gather = 0.125;

// The filter's variance, in square pixels. Cycles' Blackman-Harris filter is the window of that name with twice the
// width; its variance is 0.01918 of the square of the window's width. Its Gaussian is exp(-8 (x / width)^2).
double variance(const PixelFilter &filter) {
    const double square = filter.width * filter.width;
    return filter.shape == Shape::gaussian ? square / 16 : 4 * 0.019184 * square;
}

// Filters the shares with the kernel [share, 1 - 2 share, share].
std::vector<double> spread(const std::vector<double> &shares, double share) {
    std::vector<double> out(shares.size() + 2);
    for (std::size_t i = 0; i < shares.size(); ++i) {
        out[i] += share * shares[i];
        out[i + 1] += (1 - 2 * share) * shares[i];
        out[i + 2] += share * shares[i];
    }
    return out;
}

} // namespace

std::optional<PixelFilter> pixel_filter_of(std::string_view text) {
    const std::size_t colon = text.find(':');
    const auto *shape =
        std::ranges::find(shapes, text.substr(0, colon), [](const auto &s) { return s.first; });
    if (shape == shapes.end()) return {};
    PixelFilter filter{shape->second};
    if (colon == std::string_view::npos) return filter;
    const std::string_view width = text.substr(colon + 1);
    const auto [end, error] = std::from_chars(width.data(), width.data() + width.size(), filter.width);
    const bool valid = error == std::errc() && end == width.data() + width.size() && filter.width > 0 &&
                       filter.width <= widest;
    return valid && filter.shape != Shape::box ? std::optional(filter) : std::nullopt;
}

std::string text_of(const PixelFilter &filter) {
    const auto *shape = std::ranges::find(shapes, filter.shape, [](const auto &s) { return s.second; });
    return filter.shape == Shape::box ? std::string(shape->first)
                                      : fmt::format("{}:{:g}", shape->first, filter.width);
}

std::vector<double> subpixel_shares(const Subpixels &by) {
    std::vector<double> shares(std::size_t(by.across), 1.0 / by.across);
    if (by.filter.shape == Shape::box || by.across == 1) return shares;
    // In square sub-pixels: the missing variance, and the variance that the mean of a block brings.
    const double square = double(by.across) * by.across, more = square - 1;
    const double missing = variance(by.filter) * more - of_gather, block = more / 12;
    constexpr double most_at_once = 0.5; // at this variance, as much goes to both sides as stays
    const double rest = std::max(missing - block, 0.0);
    const int times = int(std::ceil(rest / most_at_once));
    for (int i = 0; i < times; ++i) shares = spread(shares, rest / times / 2);
    return shares;
}

} // namespace sparselens
