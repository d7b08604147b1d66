#include "dof/lens_tile.h"

#include <algorithm>
#include <array>
#include <bit>

namespace sparselens {

namespace {

constexpr float same_surface = 0.5f; // pixels of perceptive depth

// Which cell of the tile a sample falls in, seen through a lens point; cells are counted from the border's corner.
struct Placement {
    float lens_x, lens_y, shift_x, shift_y;
    float limit;
    int stride;
    std::uint32_t cell(float x, float y, float coc) const {
        const float cx = x + coc * lens_x + shift_x, cy = y + coc * lens_y + shift_y;
        const float column = cx > 0 ? (cx < limit ? cx : limit) : 0, row = cy > 0 ? (cy < limit ? cy : limit) : 0;
        return std::uint32_t(int(row) * stride + int(column));
    }
};

// Nearer is greater; of equal depths the later sample wins, whatever the order they come in.
std::uint64_t key(float depth, std::uint32_t sample) {
    return (std::uint64_t(std::bit_cast<std::uint32_t>(depth) + 1) << 32) | sample;
}

bool out_of_reach(const SampleBlock &b, const LensSample &lens, float x, float y, float size) {
    const auto [x0, x1] = std::minmax({b.coc_min * lens.x, b.coc_max * lens.x});
    const auto [y0, y1] = std::minmax({b.coc_min * lens.y, b.coc_max * lens.y});
    return b.x_max + x1 + 1 < x || b.x_min + x0 - 1 > x + size || b.y_max + y1 + 1 < y || b.y_min + y0 - 1 > y + size;
}

} // namespace

LensTile::LensTile(const BlockedSamples &samples, const SampleColours &colours, const Highlights &highlights)
    : samples_(samples), colours_(colours), highlights_(highlights), front_(stride * stride), transmittance_(stride * stride),
      over_(colours.groups * stride * stride * 4), sums_(colours.groups * size * size * 4),
      spread_(sums_.size()), weights_(size * size) {}

float LensTile::value(int x, int y, std::size_t channel) const {
    const std::size_t pixel = std::size_t(y * size + x), at = (channel / 4 * size * size + pixel) * 4 + channel % 4;
    return (weights_[pixel] > 0 ? sums_[at] / weights_[pixel] : 0) + spread_[at];
}

void LensTile::gather(const Imath::V2i &origin, std::span<const std::uint32_t> blocks,
                      std::span<const LensSample> lens, std::span<const HighlightPixel> spread) {
    origin_x_ = float(origin.x);
    origin_y_ = float(origin.y);
    blocks_.assign(blocks.begin(), blocks.end());
    partial_.clear();
    for (const std::uint32_t b : blocks_)
        for (std::uint32_t i = samples_.blocks[b].opaque_end; i < samples_.blocks[b].end; ++i) partial_.push_back(i);
    std::sort(partial_.begin(), partial_.end(), [&](std::uint32_t a, std::uint32_t b) {
        return samples_.depth[a] != samples_.depth[b] ? samples_.depth[a] > samples_.depth[b] : a < b;
    });
    std::fill(sums_.begin(), sums_.end(), 0.0f);
    std::fill(spread_.begin(), spread_.end(), 0.0f);
    std::fill(weights_.begin(), weights_.end(), 0.0f);
    for (std::uint32_t k = 0; k < lens.size(); ++k) {
        see_opaque(lens[k]);
        if (partial_.empty()) {
            add_picture(lens[k].weight);
        } else {
            see_partial(lens[k]);
            add_picture_under_partial(lens[k].weight);
        }
        spread = add_highlights(spread, k);
    }
}

void LensTile::see_opaque(const LensSample &lens) {
    std::fill(front_.begin(), front_.end(), 0);
    const Placement place{lens.x, lens.y, lens.pixel_x - origin_x_ + 1, lens.pixel_y - origin_y_ + 1,
                          float(stride - 1), stride};
    std::array<std::uint32_t, 256> cells;
    for (const std::uint32_t b : blocks_) {
        const SampleBlock &block = samples_.blocks[b];
        if (out_of_reach(block, lens, origin_x_, origin_y_, float(size))) continue;
        for (std::uint32_t begin = block.begin; begin < block.opaque_end; begin += cells.size()) {
            const std::uint32_t count = std::min(std::uint32_t(cells.size()), block.opaque_end - begin);
            const float *x = &samples_.x[begin], *y = &samples_.y[begin], *coc = &samples_.coc[begin];
            for (std::uint32_t i = 0; i < count; ++i) cells[i] = place.cell(x[i], y[i], coc[i]);
            for (std::uint32_t i = 0; i < count; ++i) {
                const std::uint64_t k = key(samples_.depth[begin + i], begin + i);
                std::uint64_t &front = front_[cells[i]];
                front = std::max(front, k);
            }
        }
    }
}

void LensTile::see_partial(const LensSample &lens) {
    std::fill(transmittance_.begin(), transmittance_.end(), 1.0f);
    std::fill(over_.begin(), over_.end(), 0.0f);
    const Placement place{lens.x, lens.y, lens.pixel_x - origin_x_ + 1, lens.pixel_y - origin_y_ + 1,
                          float(stride - 1), stride};
    for (const std::uint32_t i : partial_) {
        const std::uint32_t cell = place.cell(samples_.x[i], samples_.y[i], samples_.coc[i]);
        if (key(samples_.depth[i], i) < front_[cell]) continue;
        float &transmittance = transmittance_[cell];
        for (std::size_t g = 0; g < colours_.groups; ++g) {
            const float *colour = &colours_.group(g)[std::size_t(i) * 4];
            float *over = &over_[(g * stride * stride + cell) * 4];
            for (int k = 0; k < 4; ++k) over[k] += transmittance * colour[k];
        }
        transmittance *= 1 - samples_.alpha[i];
    }
}

void LensTile::add_picture(float weight) {
    for (std::size_t g = 0; g < colours_.groups; ++g) {
        const float *colours = colours_.group(g).data();
        for (int y = 0; y < size; ++y) {
            const std::uint64_t *front = &front_[std::size_t((y + 1) * stride + 1)];
            float *sum = &sums_[(g * size * size + std::size_t(y * size)) * 4];
            for (int x = 0; x < size; ++x, sum += 4) {
                if (front[x] == 0) continue;
                const float *colour = colours + std::size_t(std::uint32_t(front[x])) * 4;
                for (int k = 0; k < 4; ++k) sum[k] += weight * colour[k];
                if (g == 0) weights_[std::size_t(y * size + x)] += weight;
            }
        }
    }
}

void LensTile::add_picture_under_partial(float weight) {
    for (std::size_t g = 0; g < colours_.groups; ++g) {
        const float *colours = colours_.group(g).data();
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const std::size_t cell = std::size_t((y + 1) * stride + x + 1), pixel = std::size_t(y * size + x);
                const bool known = front_[cell] != 0;
                const float *over = &over_[(g * stride * stride + cell) * 4];
                const float *behind = colours + std::size_t(std::uint32_t(front_[cell])) * 4;
                const float through = known ? transmittance_[cell] : 0;
                float *sum = &sums_[(g * size * size + pixel) * 4];
                for (int k = 0; k < 4; ++k) sum[k] += weight * (over[k] + through * (known ? behind[k] : 0));
                if (g == 0) weights_[pixel] += known ? weight : weight * (1 - transmittance_[cell]);
            }
    }
}

// Whether what lies at that depth is behind something in a cell, also where a surface is torn there: a crack one
// cell wide in what is drawn as points must not let a lamp through.
bool LensTile::hides(int x, int y, float depth) const {
    const std::uint64_t limit = key(depth + same_surface, 0xffffffffu);
    const auto front = [&](int column, int row) { // the border holds what fell outside, wherever
        const bool inside = column >= 0 && row >= 0 && column < size && row < size;
        return inside && front_[std::size_t((row + 1) * stride + column + 1)] > limit;
    };
    return front(x, y) || (front(x - 1, y) && front(x + 1, y)) || (front(x, y - 1) && front(x, y + 1));
}

// Adds what lens point `lens` sees of the highlights and returns the pixels of the lens points after it.
std::span<const HighlightPixel> LensTile::add_highlights(std::span<const HighlightPixel> spread, std::uint32_t lens) {
    std::size_t done = 0;
    for (; done < spread.size() && spread[done].lens == lens; ++done) {
        const HighlightPixel &p = spread[done];
        const std::size_t cell = std::size_t((p.y + 1) * stride + p.x + 1), pixel = std::size_t(p.y * size + p.x);
        if (hides(p.x, p.y, samples_.depth[highlights_.sample[p.highlight]])) continue;
        const float weight = p.weight * (partial_.empty() ? 1 : transmittance_[cell]);
        for (std::size_t g = 0; g < colours_.groups; ++g)
            for (std::size_t k = 0; k < 4; ++k)
                spread_[(g * size * size + pixel) * 4 + k] +=
                    weight * highlights_.light.group(g)[std::size_t(p.highlight) * 4 + k];
    }
    return spread.subspan(done);
}

} // namespace sparselens
