#include "ldi/reproject.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {

Reprojection::Reprojection(const View &view, double focal_px)
    : view_(view), shift_x_(focal_px * view.position.x),
      shift_y_(-focal_px * view.position.y * double(view.image.windows.pixel_aspect)),
      reach_(std::size_t(view.image.windows.height())) {
    if (const std::size_t k = find_channel(view.image.channels, "A"); k != npos) alpha_ = view.image.plane(k);
    const std::size_t width = std::size_t(view.image.windows.width());
    parallel_for(reach_.size(), [&](std::size_t row) {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t i = row * width; i < (row + 1) * width; ++i)
            if (is_visible(i)) nearest = std::min(nearest, double(view_.z[i]));
        const double x = shift_x_ / nearest, y = shift_y_ / nearest;
        reach_[row] = {std::min(x, 0.0), std::max(x, 0.0), std::min(y, 0.0), std::max(y, 0.0)};
    });
}

bool Reprojection::is_visible(std::size_t source) const { return alpha_.empty() || alpha_[source] != 0; }

Imath::Box2i Reprojection::reach() const {
    const Windows &w = view_.image.windows;
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
    const Windows &w = view_.image.windows;
    const std::size_t width = std::size_t(w.width());
    for (std::size_t row = 0; row < reach_.size(); ++row) {
        const double centre = double(w.data.min.y) + double(row) + 0.5;
        if (centre + reach_[row].down < first_row || centre + reach_[row].up >= last_row + 1) continue;
        for (std::size_t column = 0; column < width; ++column) {
            const std::size_t source = row * width + column;
            const double inverse_z = 1 / double(view_.z[source]);
            const double y = centre + shift_y_ * inverse_z, cell_y = std::floor(y);
            if (!(cell_y >= first_row && cell_y <= last_row)) continue;
            if (!is_visible(source)) continue;
            const double x = double(w.data.min.x) + double(column) + 0.5 + shift_x_ * inverse_z;
            const double cell_x = std::floor(x);
            if (!(std::abs(cell_x) < 1e9)) continue; // nearer than any picture is wide: not in it
            out.push_back({int(cell_x), int(cell_y), float(x - cell_x - 0.5), float(y - cell_y - 0.5),
                           float(inverse_z), std::uint32_t(source)});
        }
    }
}

} // namespace sparselens
