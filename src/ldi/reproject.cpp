#include "ldi/reproject.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {

Reprojection::Reprojection(const Ldi &view, const Imath::V2d &position, double focal_px)
    : view_(view), shift_x_(focal_px * position.x),
      shift_y_(-focal_px * position.y * double(view.windows.pixel_aspect)),
      reach_(std::size_t(view.windows.height())) {
    const std::size_t width = std::size_t(view.windows.width());
    parallel_for(reach_.size(), [&](std::size_t row) {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::uint64_t i = view_.begin[row * width]; i < view_.begin[(row + 1) * width]; ++i)
            nearest = std::min(nearest, double(view_.z[i]));
        const double x = shift_x_ / nearest, y = shift_y_ / nearest;
        reach_[row] = {std::min(x, 0.0), std::max(x, 0.0), std::min(y, 0.0), std::max(y, 0.0)};
    });
}

Imath::Box2i Reprojection::reach() const {
    const Windows &w = view_.windows;
    constexpr double far_off = 1 << 28; // keeps the box's corners integers
    Imath::Box2d box;
    for (std::size_t row = 0; row < reach_.size(); ++row) {
        const double centre = double(w.data.min.y) + double(row) + 0.5;
        box.extendBy(Imath::V2d(w.data.min.x + 0.5 + reach_[row].left, centre + reach_[row].up));
        box.extendBy(Imath::V2d(w.data.max.x + 0.5 + reach_[row].right, centre + reach_[row].down));
    }
    const auto whole = [&](double v) { return int(std::floor(std::clamp(v, -far_off, far_off))); };
    return {{whole(box.min.x), whole(box.min.y)}, {whole(box.max.x), whole(box.max.y)}};
}

void Reprojection::append_rows(int first_row, int last_row, std::vector<ReprojectedSample> &out) const {
    const Windows &w = view_.windows;
    const std::size_t width = std::size_t(w.width());
    for (std::size_t row = 0; row < reach_.size(); ++row) {
        const double centre = double(w.data.min.y) + double(row) + 0.5;
        if (centre + reach_[row].down < first_row || centre + reach_[row].up >= last_row + 1) continue;
        for (std::size_t column = 0; column < width; ++column) {
            const std::size_t pixel = row * width + column;
            for (std::uint64_t i = view_.begin[pixel]; i < view_.begin[pixel + 1]; ++i) {
                const double inverse_z = 1 / double(view_.z[i]);
                const double y = centre + shift_y_ * inverse_z, cell_y = std::floor(y);
                if (!(cell_y >= first_row && cell_y <= last_row)) continue;
                const double x = double(w.data.min.x) + double(column) + 0.5 + shift_x_ * inverse_z;
                const double cell_x = std::floor(x);
                if (!(std::abs(cell_x) < 1e9)) continue; // nearer than any picture is wide: not in it
                out.push_back({int(cell_x), int(cell_y), float(x - cell_x - 0.5), float(y - cell_y - 0.5),
                               float(inverse_z), std::uint32_t(i)});
            }
        }
    }
}

} // namespace sparselens
