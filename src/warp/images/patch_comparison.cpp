#include "warp/images/patch_comparison.h"

#include "warp/images/patch_rows.h"
#include "warp/tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {

namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
constexpr double alike = 1e-6; // steps of a pixel in both views

} // namespace

PatchComparison::PatchComparison(const MatchedView &centre, const Imath::Box2i &block, float surface)
    : surface_(surface), corner_(block.min - Imath::V2i(reach)),
      width_(block.max.x - block.min.x + 1 + 2 * reach), height_(block.max.y - block.min.y + 1 + 2 * reach) {
    const float *from = centre.cut(Imath::V2d(corner_) + Imath::V2d(0.5)).first;
    counts_.fill(0);
    depths_.fill(unknown);
    sums_of_counts_.fill(0);
    if (!from) return;
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < row; ++x) {
            const std::size_t i = at(x, y);
            const float *pixel = from + y * MatchedView::row + x;
            for (std::size_t k = 0; k < 3; ++k) own_[k][i] = pixel[int(k) * MatchedView::plane];
            const float depth = pixel[3 * MatchedView::plane];
            const bool counts = kernels::is_one_surface(depth, surface_, one_mirror_px);
            counts_[i] = counts ? 1 : 0;
            depths_[i] = counts ? depth : unknown;
        }
    sums_of_counts_ = counts_;
    sum_patches(sums_of_counts_.data(), width_, height_);
}

template <typename PlaceAt>
void PatchComparison::compare_each(const MatchedView &view, const PlaceAt &place_at) {
    squares_.fill(0), compared_.fill(0);
    all_compared_ = false;
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            const std::size_t i = at(x, y);
            MatchedView::Pixel seen;
            if (counts_[i] == 0 || !view.at(place_at(x, y), seen) ||
                !kernels::is_one_surface(seen[3], surface_, one_mirror_px))
                continue;
            for (std::size_t k = 0; k < 3; ++k) {
                const float differs = own_[k][i] - seen[k];
                squares_[i] += differs * differs;
            }
            compared_[i] = 1;
        }
}

void PatchComparison::take(std::span<float> out) {
    const int columns = width_ - 2 * reach, rows = height_ - 2 * reach;
    sum_patches(squares_.data(), width_, height_);
    if (!all_compared_) sum_patches(compared_.data(), width_, height_);
    const Field &counts = all_compared_ ? sums_of_counts_ : compared_;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            const float count = counts[at(x, y)];
            out[std::size_t(y * columns + x)] =
                count >= WarpTuning::image_least_patch * patch * patch ? squares_[at(x, y)] / count : unknown;
        }
}

void PatchComparison::at_depth(const MatchedView &view, double depth, std::span<float> out) {
    const auto in_view = [&](int x, int y) {
        return view.in_view(Imath::V2d(corner_ + Imath::V2i(x, y)) + Imath::V2d(0.5), depth);
    };
    const Imath::V2d first = in_view(0, 0); // of equal steps, because the mapping at one depth is linear
    const double step = in_view(1, 0).x - first.x;
    if (!(std::abs(step - 1) < alike)) {
        compare_each(view, [&](int x, int y) { return first + step * Imath::V2d(x, y); });
    } else if (const MatchedView::Cutout seen = view.cut(first); seen.first) {
        all_compared_ = compare_shifted(
            {{own_[0].data(), own_[1].data(), own_[2].data()}, counts_.data(), surface_, width_, height_},
            seen, squares_.data(), compared_.data());
    } else {
        std::fill_n(out.begin(), (width_ - 2 * reach) * (height_ - 2 * reach), unknown);
        return;
    }
    take(out);
}

void PatchComparison::at_depths(const MatchedView &view, const Field &depths, double behind,
                                std::span<float> out) {
    const auto in_view = [&](int x, int y, double depth) {
        return view.in_view(Imath::V2d(corner_ + Imath::V2i(x, y)) + Imath::V2d(0.5), depth);
    };
    const auto depth_at = [&](int x, int y) { return double(depths[at(x, y)]) + behind; };
    if (view.mapping().approach() == 0) {
        // No camera stands farther forward, so the mapping is linear in depth, too.
        const Imath::V2d first = in_view(0, 0, 0), along = in_view(0, 0, 1) - first;
        const double step = in_view(1, 0, 0).x - first.x;
        compare_each(view,
                     [&](int x, int y) { return first + step * Imath::V2d(x, y) + depth_at(x, y) * along; });
    } else {
        compare_each(view, [&](int x, int y) { return in_view(x, y, depth_at(x, y)); });
    }
    take(out);
}

} // namespace sparselens
