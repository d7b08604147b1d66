#include "warp/images/patch_rows.h"

#include "base/float4.h"

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

} // namespace sparselens
