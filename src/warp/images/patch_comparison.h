// A block of pixels of the centre view in comparison with another view, patch by patch, if what it shows lies at a depth that
// is tried. Only pixels of one surface count, and only where the view shows that surface.
#pragma once

#include "warp/images/matched_view.h"

#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace sparselens {

// Sums over the patches of a block of values at its pixels and those around.
class Patches {
public:
    static constexpr int reach = 3, patch = 2 * reach + 1; // pixels
    static constexpr int most_side = 8 + 2 * reach;        // a block and what lies around

    explicit Patches(const Imath::Box2i &block)
        : corner(block.min - Imath::V2i(reach)), width(block.max.x - block.min.x + 1 + 2 * reach),
          height(block.max.y - block.min.y + 1 + 2 * reach) {}

    Imath::V2i corner;
    int width, height;
    std::array<float, most_side * most_side> value{}, count{};

    void clear() { value.fill(0), count.fill(0); }
    std::size_t at(int x, int y) const { return std::size_t(y * most_side + x); }
    void sum() { sum(value), sum(count); } // afterwards at(x, y) holds the patch whose corner that is

private:
    void sum(std::array<float, most_side * most_side> &v) const {
        for (int y = 0; y < height; ++y)
            for (int x = 0; x + patch <= width; ++x) {
                float total = 0;
                for (int i = 0; i < patch; ++i) total += v[at(x + i, y)];
                v[at(x, y)] = total;
            }
        for (int y = 0; y + patch <= height; ++y)
            for (int x = 0; x + patch <= width; ++x) {
                float total = 0;
                for (int i = 0; i < patch; ++i) total += v[at(x, y + i)];
                v[at(x, y)] = total;
            }
    }
};

inline float squared_difference(const MatchedView::Pixel &a, const MatchedView::Pixel &b) {
    float sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sum;
}

class PatchComparison {
public:
    PatchComparison(const MatchedView &centre, const MatchedView &view, double scale,
                    const Imath::Box2i &block, float surface)
        : view_(view), scale_(scale), surface_(surface), patches_(block) {
        for (int y = 0; y < patches_.height; ++y)
            for (int x = 0; x < patches_.width; ++x) {
                const Imath::V2i p = patches_.corner + Imath::V2i(x, y);
                if (!centre.contains(p.x, p.y)) continue;
                const MatchedView::Pixel &pixel = centre.at(p.x, p.y);
                if (on_surface(pixel[3])) own_[owns_++] = {x, y, pixel};
            }
    }

    // Puts the difference at each pixel of the block if what it and those around show lies at one perceptive depth.
    void at_depth(double depth, std::span<float> out) {
        const auto in_view = [&](int x, int y) {
            return view_.mapping().in_view(Imath::V2d(patches_.corner + Imath::V2i(x, y)) + Imath::V2d(0.5),
                                           depth / scale_);
        };
        const Imath::V2d first = in_view(0, 0); // of equal steps: at one depth the mapping is linear
        const double step = in_view(1, 0).x - first.x;
        differences([&](int x, int y) { return first + step * Imath::V2d(x, y); }, out);
    }
    // The same if they lie at the depths that depth_at(pixel) says; a pixel whose depth is NaN does not count.
    template <typename DepthAt>
    void at_depths(const DepthAt &depth_at, std::span<float> out) {
        differences(
            [&](int x, int y) {
                const Imath::V2i p = patches_.corner + Imath::V2i(x, y);
                return view_.mapping().in_view(Imath::V2d(p) + Imath::V2d(0.5), depth_at(p) / scale_);
            },
            out);
    }

private:
    static constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
    static constexpr float least_share = 0.4f; // of a patch, to be compared

    bool on_surface(float depth) const { return kernels::is_one_surface(depth, surface_, one_mirror_px); }

    template <typename PlaceAt>
    void differences(const PlaceAt &place_at, std::span<float> out) {
        patches_.clear();
        for (std::size_t n = 0; n < owns_; ++n) {
            const Own &own = own_[n];
            MatchedView::Pixel seen;
            if (!view_.at(place_at(own.x, own.y), seen) || !on_surface(seen[3])) continue;
            patches_.value[patches_.at(own.x, own.y)] = squared_difference(own.pixel, seen);
            patches_.count[patches_.at(own.x, own.y)] = 1;
        }
        patches_.sum();
        const int columns = patches_.width - 2 * Patches::reach, rows = patches_.height - 2 * Patches::reach;
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x) {
                const float count = patches_.count[patches_.at(x, y)];
                out[std::size_t(y * columns + x)] = count >= least_share * Patches::patch * Patches::patch
                                                        ? patches_.value[patches_.at(x, y)] / count
                                                        : unknown;
            }
    }

    const MatchedView &view_;
    double scale_;
    float surface_;
    Patches patches_;
    // The centre view's pixels that show the surface.
    struct Own {
        int x, y; // from the corner
        MatchedView::Pixel pixel;
    };
    std::array<Own, std::size_t(Patches::most_side) * Patches::most_side> own_;
    std::size_t owns_ = 0;
};

} // namespace sparselens
