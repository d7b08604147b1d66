// The samples of a view with at most one per pixel, and the samples around them. Depths are perceptive, R F / z:
// pixels, larger is nearer.
#pragma once

#include "base/coverage.h"
#include "base/grid.h"
#include "base/parallel.h"
#include "deep/view_samples.h"
#include "lens/perceptive_depth.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace sparselens {

class SamplesAround {
public:
    // Refers to the view; scale is R F, pixels times scene units.
    SamplesAround(const ViewSamples &view, double scale)
        : view_(view), grid_(view.windows.width(), view.windows.height()), alpha_(view.alpha()),
          rgb_(find_rgb(view.channels)), depths_(grid_.size()) {
        parallel_ranges(depths_.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) depths_[i] = perceptive_depth(scale, double(view.z(i)));
        });
    }

    bool have_colours() const { return alpha_ != npos && all_found(rgb_); }
    const Grid &grid() const { return grid_; } // of the window, from its corner
    bool is_empty(std::size_t pixel) const { return view_.pixel(pixel).empty(); }
    std::uint64_t own_sample(int x, int y) const { return view_.pixel(grid_.index(x, y)).front(); }

    double depth_of(std::uint64_t i) const { return depths_[i]; }
    std::span<const double> depths() const { return depths_; } // of all pixels
    bool is_opaque(std::uint64_t i) const { return sparselens::is_opaque(alpha_at(view_, alpha_, i)); }
    Imath::V3d colour_of(std::uint64_t i) const {
        const auto value = [&](std::size_t k) { return double(view_.value(rgb_[k], i)); };
        return {value(0), value(1), value(2)};
    }

    Imath::V4d rgba_of(std::uint64_t i) const {
        const Imath::V3d c = colour_of(i);
        return {c.x, c.y, c.z, double(alpha_at(view_, alpha_, i))};
    }

    // Calls visit(sample, dx, dy) for the samples of the pixels within `reach` of (x, y).
    template <typename Visit>
    void around(int x, int y, int reach, const Visit &visit) const {
        for (int v = std::max(y - reach, 0); v <= std::min(y + reach, grid_.height() - 1); ++v)
            for (int u = std::max(x - reach, 0); u <= std::min(x + reach, grid_.width() - 1); ++u)
                if (const std::size_t pixel = grid_.index(u, v); !is_empty(pixel))
                    visit(view_.pixel(pixel).front(), u - x, v - y);
    }

private:
    const ViewSamples &view_;
    Grid grid_;
    std::size_t alpha_;
    std::array<std::size_t, 3> rgb_;
    std::vector<double> depths_; // of each pixel
};

} // namespace sparselens
