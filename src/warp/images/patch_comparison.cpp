#include "warp/images/patch_comparison.h"

#include "warp/tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {

namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
constexpr double alike = 1e-6; // steps of a pixel in both views

using Field = PatchComparison::Field;

// A sum of seven, of which pairs are known.
float sum_of(const float *pairs, int step, float last) {
    return (pairs[0] + pairs[2 * step]) + (pairs[4 * step] + last);
}

// Afterwards a pixel holds the sum over the patch whose upper left corner it is.
template <int columns>
void sum_patches(Field &field, int rows) {
    constexpr int row = PatchComparison::row, sums = columns - PatchComparison::patch + 1;
    constexpr int most = PatchComparison::most_side - 1; // pairs of rows
    static_assert(PatchComparison::patch == 7);
    float *v = field.data();
    float pairs[most * columns];
    for (int y = 0; y < rows + 5; ++y)
        for (int x = 0; x < columns; ++x) pairs[y * columns + x] = v[y * row + x] + v[(y + 1) * row + x];
    for (int y = 0; y < rows; ++y) {
        float down[columns], beside[columns - 1];
        for (int x = 0; x < columns; ++x)
            down[x] = sum_of(&pairs[y * columns + x], columns, v[(y + 6) * row + x]);
        for (int x = 0; x < columns - 1; ++x) beside[x] = down[x] + down[x + 1];
        for (int x = 0; x < sums; ++x) v[y * row + x] = sum_of(&beside[x], 1, down[x + 6]);
    }
}
void sum_patches(Field &field, int width, int rows) {
    if (width <= 8)
        sum_patches<8>(field, rows);
    else
        sum_patches<16>(field, rows);
}

} // namespace

PatchComparison::PatchComparison(const MatchedView &centre, double scale, const Imath::Box2i &block,
                                 float surface)
    : scale_(scale), surface_(surface), corner_(block.min - Imath::V2i(reach)),
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
    sum_patches(sums_of_counts_, width_, height_ - 2 * reach);
}

// Where both views are framed alike, the block is moved as a whole: no pixel needs a place of its own.
template <int columns>
void PatchComparison::compare_shifted(const MatchedView::Cutout &seen) {
    const bool moves_right = seen.right != 0, moves_down = seen.down != 0;
    const auto between = [&](const float *line, float *out) {
        if (!moves_right) return void(std::copy_n(line, columns, out));
        for (int x = 0; x < columns; ++x) out[x] = line[x] + seen.right * (line[x + 1] - line[x]);
    };
    float above[3][columns]; // local copies: the compiler need not fear that what is written is read
    for (int k = 0; k < 3; ++k) between(seen.first + k * MatchedView::plane, above[k]);
    const float *nearest = seen.first + 3 * MatchedView::plane + (seen.down < 0.5f ? 0 : MatchedView::row) +
                           (seen.right < 0.5f ? 0 : 1);
    float missing[columns]{};
    for (int y = 0; y < height_; ++y, nearest += MatchedView::row) {
        float squares[columns]{}, compared[columns];
        for (int k = 0; k < 3; ++k) {
            const float *own = &own_[std::size_t(k)][at(0, y)];
            float below[columns];
            between(seen.first + k * MatchedView::plane + (y + 1) * MatchedView::row, below);
            if (moves_down)
                for (int x = 0; x < columns; ++x) above[k][x] += seen.down * (below[x] - above[k][x]);
            for (int x = 0; x < columns; ++x) {
                const float differs = own[x] - above[k][x];
                squares[x] += differs * differs;
                above[k][x] = below[x];
            }
        }
        const float *counts = &counts_[at(0, y)];
        for (int x = 0; x < columns; ++x) {
            compared[x] = kernels::is_one_surface(nearest[x], surface_, one_mirror_px) ? counts[x] : 0;
            squares[x] = compared[x] != 0 ? squares[x] : 0;
            missing[x] += counts[x] - compared[x];
        }
        std::copy_n(squares, columns, &squares_[at(0, y)]);
        std::copy_n(compared, columns, &compared_[at(0, y)]);
    }
    all_compared_ = std::ranges::all_of(missing, [](float m) { return m == 0; });
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
    sum_patches(squares_, width_, rows);
    if (!all_compared_) sum_patches(compared_, width_, rows);
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
        return view.mapping().in_view(Imath::V2d(corner_ + Imath::V2i(x, y)) + Imath::V2d(0.5),
                                      depth / scale_);
    };
    const Imath::V2d first = in_view(0, 0); // of equal steps: at one depth the mapping is linear
    const double step = in_view(1, 0).x - first.x;
    if (!(std::abs(step - 1) < alike)) {
        compare_each(view, [&](int x, int y) { return first + step * Imath::V2d(x, y); });
    } else if (const MatchedView::Cutout seen = view.cut(first); seen.first) {
        if (width_ <= 8)
            compare_shifted<8>(seen);
        else
            compare_shifted<16>(seen);
    } else {
        std::fill_n(out.begin(), (width_ - 2 * reach) * (height_ - 2 * reach), unknown);
        return;
    }
    take(out);
}

void PatchComparison::at_depths(const MatchedView &view, const Field &depths, double behind,
                                std::span<float> out) {
    compare_each(view, [&](int x, int y) {
        return view.mapping().in_view(Imath::V2d(corner_ + Imath::V2i(x, y)) + Imath::V2d(0.5),
                                      (double(depths[at(x, y)]) + behind) / scale_);
    });
    take(out);
}

} // namespace sparselens
