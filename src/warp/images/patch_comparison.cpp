#include "warp/images/patch_comparison.h"

#include "base/numbers.h"
#include "warp/tuning.h"

#include <cmath>

namespace sparselens {

namespace {

using Mask4 [[gnu::vector_size(16)]] = int;

constexpr Float4 none{};

// Like kernels::is_one_surface().
Mask4 on_surface(Float4 depths, float surface) {
    const Float4 off = depths - surface;
    return ((off < one_mirror_px) & (off > -one_mirror_px)) | (depths == surface);
}

Float4 where(Mask4 mask, Float4 value) { return Float4(mask & Mask4(value)); }

// Interpolates between four pixels and their neighbours to the right.
Float4 between(const float *pixels, float right) {
    const Float4 left = load4(pixels);
    return left + right * (load4(pixels + 1) - left);
}

// Compares `groups` groups of four columns.
template <int groups>
bool compare_groups(const PatchBlock &block, const MatchedView::Cutout &seen, float *squares,
                    float *compared) {
    const float right = seen.right, down = seen.down, surface = block.surface;
    Float4 above[3][groups], missing{};
    for (int k = 0; k < 3; ++k)
        for (int g = 0; g < groups; ++g)
            above[k][g] = between(seen.first + k * MatchedView::plane + 4 * g, right);
    const float *line = seen.first + MatchedView::row;
    const float *nearest =
        seen.first + 3 * MatchedView::plane + (down < 0.5f ? 0 : MatchedView::row) + (right < 0.5f ? 0 : 1);
    for (int y = 0; y < block.height; ++y, line += MatchedView::row, nearest += MatchedView::row)
        for (int g = 0; g < groups; ++g) {
            const int at = y * patch_row + 4 * g;
            Float4 sum{};
            for (int k = 0; k < 3; ++k) {
                const Float4 below = between(line + k * MatchedView::plane + 4 * g, right);
                const Float4 differs =
                    load4(block.own[k] + at) - (above[k][g] + down * (below - above[k][g]));
                sum += differs * differs;
                above[k][g] = below;
            }
            const Float4 counts = load4(block.counts + at),
                         both = where(on_surface(load4(nearest + 4 * g), surface), counts);
            store4(squares + at, where(both != none, sum));
            store4(compared + at, both);
            missing += counts - both;
        }
    return missing[0] + missing[1] + missing[2] + missing[3] == 0;
}

// Adds seven values, in pairs first.
template <typename Value>
Value sum_of(Value a, Value b, Value c, Value d, Value e, Value f, Value g) {
    return ((a + b) + (c + d)) + ((e + f) + g);
}

// Sums each column over the height of a patch.
void sum_down(float *values, int columns, int height) {
    static_assert(patch_side == 7);
    for (int x = 0; x < columns; x += 4) {
        float *v = values + x;
        Float4 rows[patch_side];
        for (int y = 0; y < patch_side - 1; ++y) rows[y] = load4(v + y * patch_row);
        for (int y = 0; y + patch_side <= height; ++y) {
            rows[patch_side - 1] = load4(v + (y + patch_side - 1) * patch_row);
            store4(v + y * patch_row, sum_of(rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], rows[6]));
            for (int n = 0; n + 1 < patch_side; ++n) rows[n] = rows[n + 1];
        }
    }
}

void sum_along(float *v, int sums) {
    if (sums > 2) {
        for (int x = 0; x < 8; x += 4, v += 4)
            store4(v, sum_of(load4(v), load4(v + 1), load4(v + 2), load4(v + 3), load4(v + 4), load4(v + 5),
                             load4(v + 6)));
    } else {
        for (int x = 0; x < sums; ++x, ++v) *v = sum_of(v[0], v[1], v[2], v[3], v[4], v[5], v[6]);
    }
}

} // namespace

bool compare_shifted(const PatchBlock &block, const MatchedView::Cutout &seen, float *squares,
                     float *compared) {
    return block.width <= 8 ? compare_groups<2>(block, seen, squares, compared)
                            : compare_groups<4>(block, seen, squares, compared);
}

void sum_patches(float *values, int width, int height) {
    sum_down(values, width <= 8 ? 8 : patch_row, height);
    for (int y = 0; y + patch_side <= height; ++y) sum_along(values + y * patch_row, width - patch_side + 1);
}

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
