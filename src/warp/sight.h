// How far a view sees in each of its pixels.
#pragma once

#include "base/grid.h"
#include "deep/view_samples.h"

#include <Imath/ImathVec.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace sparselens {

// 1 / z of the farthest thing that each pixel of a view shows; 0: it lets light through to infinity.
std::vector<float> farthest_in(const ViewSamples &view);

// The least value in a square around each pixel.
std::vector<float> least_around(const std::vector<float> &values, const Grid &grid, int radius);

// Looks up values of a view by position.
class Sight {
public:
    Sight(const ViewSamples &view, std::vector<float> values)
        : display_(view.windows.display), grid_(view.windows.data), values_(std::move(values)) {}

    // Returns nothing where the view does not look, and 0 where it has no pixel, because it shows nothing there.
    std::optional<float> at(const Imath::V2d &place) const {
        if (!(std::abs(place.x) < 1e9 && std::abs(place.y) < 1e9)) return {};
        const Imath::V2i pixel(int(std::floor(place.x)), int(std::floor(place.y)));
        if (grid_.contains(pixel.x, pixel.y)) return values_[grid_.index(pixel.x, pixel.y)];
        return display_.intersects(pixel) ? std::optional(0.0f) : std::nullopt;
    }

private:
    Imath::Box2i display_;
    Grid grid_;
    std::vector<float> values_;
};

// 1 / z of the farthest thing in a pixel of the view and in those around it, up to WarpTuning::sight_margin.
Sight farthest_around(const ViewSamples &view, const std::vector<float> &farthest);

} // namespace sparselens
