// What a lens point sees where it meets nothing opaque: through cracks between the samples of one surface, that surface;
// elsewhere, fillers.
#include "dof/lens/lens_tile.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

constexpr float side_by_side = 1.5f; // pixels: samples that are no farther apart have none between them

} // namespace

// The sample that shows through a crack at an empty cell, as a key; 0: there is no crack.
std::uint64_t LensTile::torn_at(std::size_t cell) const {
    const auto depth = [&](std::uint64_t key) { return samples_.depth[std::uint32_t(key)]; };
    std::uint64_t farthest = 0;
    for (const std::size_t step : {std::size_t{1}, std::size_t(stride)}) {
        const std::uint64_t one = front_[cell - step], other = front_[cell + step];
        if (std::min(one, other) <= nearest_background) continue;
        const std::uint32_t a = std::uint32_t(one), b = std::uint32_t(other);
        if (std::abs(samples_.x[a] - samples_.x[b]) >= side_by_side) continue;
        if (std::abs(samples_.y[a] - samples_.y[b]) >= side_by_side) continue;
        if (std::abs(depth(one) - depth(other)) >= float(one_surface_px)) continue;
        const std::uint64_t farther = depth(one) <= depth(other) ? one : other;
        if (farthest == 0 || depth(farther) < depth(farthest)) farthest = farther;
    }
    return farthest;
}

void LensTile::find_cracks() {
    cracks_.clear();
    for (const std::uint32_t cell : empty_)
        if (const std::uint64_t key = torn_at(cell)) cracks_.push_back({cell, key});
}

void LensTile::close_cracks() {
    for (const Crack &crack : cracks_) front_[crack.cell] = crack.key;
}

// The fillers of empty cells, and of them those that show.
void LensTile::see_fillers(const LensSample &lens) {
    if (empty_.empty()) return;
    Cells cells{size, size, 0, 0};
    for (const std::uint32_t cell : empty_) {
        const int x = column_of(cell), y = row_of(cell);
        cells = {std::min(cells.left, x), std::min(cells.top, y), std::max(cells.right, x + 1),
                 std::max(cells.bottom, y + 1)};
    }
    see_opaque(lens, fillers_.samples, blocks_->fillers, cells, filler_);
    for (const std::uint32_t cell : empty_) {
        std::uint64_t &filler = filler_[cell];
        if (filler != 0 &&
            hides(column_of(cell), row_of(cell), fillers_.samples.depth[std::uint32_t(filler)]))
            filler = 0;
    }
}

// The colour that the lens point sees of what is opaque in a cell, a filler included; null where that is unknown.
const float *LensTile::opaque_colour(std::size_t group, std::size_t cell) const {
    if (front_[cell] != 0) return &colours_.group(group)[std::size_t(std::uint32_t(front_[cell])) * 4];
    if (filler_[cell] == 0) return nullptr;
    return &fillers_.colours.group(group)[std::size_t(std::uint32_t(filler_[cell])) * 4];
}

float LensTile::opaque_passes(int x, int y) const {
    const std::size_t cell = cell_of(x, y);
    return passes(x, y,
                  front_[cell] != 0 ? samples_.depth[std::uint32_t(front_[cell])]
                                    : fillers_.samples.depth[std::uint32_t(filler_[cell])]);
}

// Adds what it sees in those cells: through cracks, and fillers.
void LensTile::add_unseen(float weight) {
    for (const std::uint32_t cell : empty_) {
        const int x = column_of(cell), y = row_of(cell);
        const std::size_t pixel = std::size_t(y * size + x);
        if (front_[cell] == 0 && filler_[cell] == 0) {
            unknown_[pixel] += weight;
            continue;
        }
        const float share = held_out_.by ? weight * opaque_passes(x, y) : weight;
        for (std::size_t g = 0; g < colours_.groups; ++g) {
            const float *colour = opaque_colour(g, cell);
            float *sum = &sums_[(g * size * size + pixel) * 4];
            for (std::size_t k = 0; k < 4; ++k) sum[k] += share * colour[k];
        }
    }
}

} // namespace sparselens
