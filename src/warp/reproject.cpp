#include "warp/reproject.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {

Reprojection::Reprojection(const ViewSamples &view, const ViewMapping &mapping)
    : view_(view), mapping_(mapping), reach_(std::size_t(view.windows.height())) {
    const Imath::Box2i &data = view.windows.data;
    parallel_for(reach_.size(), [&](std::size_t row) {
        double nearest = std::numeric_limits<double>::infinity();
        const int row_y = data.min.y + int(row);
        for (int x = data.min.x; x <= data.max.x; ++x)
            for (const std::uint64_t i : view_.pixel(view_.windows.index(x, row_y)))
                nearest = std::min(nearest, double(view_.z(i)));
        // Positions are linear in the column and in 1 / z, so the extremes lie at the ends of both.
        const double y = row_y + 0.5;
        for (const double x : {data.min.x + 0.5, data.max.x + 0.5})
            for (const double inverse_z : {0.0, 1 / nearest})
                reach_[row].extendBy(mapping_.at_infinity({x, y}) + mapping_.parallax({x, y}) * inverse_z);
    });
}

Imath::Box2i Reprojection::reach() const {
    constexpr double far_off = 1 << 28; // keeps the box's corners integers
    Imath::Box2d box;
    for (const Imath::Box2d &row : reach_) box.extendBy(row);
    const auto whole = [&](double v) { return int(std::floor(std::clamp(v, -far_off, far_off))); };
    return {{whole(box.min.x), whole(box.min.y)}, {whole(box.max.x), whole(box.max.y)}};
}

void Reprojection::append_rows(int first_row, int last_row, std::vector<ReprojectedSample> &out) const {
    const Imath::Box2i &data = view_.windows.data;
    const Grid grid = view_.windows.grid();
    for (std::size_t row = 0; row < reach_.size(); ++row) {
        if (!may_reach(row, first_row, last_row)) continue;
        const int from_y = data.min.y + int(row);
        for (int from_x = data.min.x; from_x <= data.max.x; ++from_x) {
            const std::size_t pixel = grid.index(from_x, from_y);
            if (view_.pixel(pixel).empty()) continue;
            const Imath::V2d q(from_x + 0.5, from_y + 0.5);
            const Imath::V2d far = mapping_.at_infinity(q), parallax = mapping_.parallax(q);
            for (const std::uint64_t i : view_.pixel(pixel)) {
                const double inverse_z = 1 / double(view_.z(i));
                const double y = far.y + parallax.y * inverse_z;
                // true for most samples of views from above or below
                if (!(y >= first_row && y < last_row + 1)) continue;
                const double x = far.x + parallax.x * inverse_z, cell_x = std::floor(x),
                             cell_y = std::floor(y);
                if (!(std::abs(cell_x) < 1e9)) continue; // so near that it lies outside of any picture
                out.push_back({int(cell_x), int(cell_y), float(x - cell_x - 0.5), float(y - cell_y - 0.5),
                               float(inverse_z), std::uint32_t(i)});
            }
        }
    }
}

} // namespace sparselens
