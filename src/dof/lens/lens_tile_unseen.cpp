// What a lens point sees that is not the nearest sample: of mirrors and glass, the image, in the window that their surface is;
// where it meets nothing opaque, a surface through the cracks between its samples; elsewhere, fillers. The rules:
// lens_gather_reference.h.
#include "dof/lens/lens_tile.h"
#include "dof/lens/tile_projection.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sparselens {

void LensTile::see_images(const LensSample &lens) {
    sees_images_ = false;
    if (samples_.surface_coc.empty()) return;
    image_.assign(stride * stride, 0);
    const TileProjection projection(lens, origin_x_ - (border - 1), origin_y_ - (border - 1), stride);
    std::array<std::int32_t, 256> cells;
    for (const std::uint32_t b : blocks_->samples) {
        const SampleBlock &block = samples_.blocks[b];
        if (!block.shows_images) continue;
        sees_images_ = true;
        for (std::uint32_t begin = block.begin; begin < block.opaque_end;
             begin += std::uint32_t(cells.size())) {
            const std::uint32_t count = std::min(std::uint32_t(cells.size()), block.opaque_end - begin);
            project_to_cells(projection, &samples_.x[begin], &samples_.y[begin], &samples_.coc[begin], count,
                             cells.data());
            for (std::uint32_t i = 0; i < count; ++i) {
                if (!samples_.is_image(begin + i)) continue;
                std::uint32_t &nearest = image_[std::size_t(cells[i])];
                if (nearest == 0 || samples_.coc[begin + i] < samples_.coc[nearest - 1])
                    nearest = begin + i + 1;
            }
        }
    }
    if (!sees_images_) return;
    shown_ = front_;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) shown_[cell_of(x, y)] = image_at(cell_of(x, y));
}

// The key of the sample that shows what is seen of the front one in a cell.
std::uint64_t LensTile::image_at(std::size_t cell) const {
    const std::uint64_t front = front_[cell];
    if (front == 0 || !samples_.is_image(std::uint32_t(front))) return front;
    const float depth = samples_.depth[std::uint32_t(front)];
    for (const std::size_t at : {cell, cell - 1, cell + 1, cell - stride, cell + stride}) {
        const std::uint32_t image = image_[at];
        if (image != 0 && kernels::is_in_mirror(samples_.depth[image - 1], depth))
            return samples_.key[image - 1];
    }
    return front;
}

// The sample that shows through a crack at an empty cell, as a key; 0: there is no crack.
std::uint64_t LensTile::torn_at(std::size_t cell) const {
    const auto depth = [&](std::uint64_t key) { return samples_.depth[std::uint32_t(key)]; };
    std::uint64_t farthest = 0;
    for (const std::size_t step : {std::size_t{1}, std::size_t(stride)}) {
        const std::uint64_t one = front_[cell - step], other = front_[cell + step];
        if (is_background(one) || is_background(other)) continue;
        const std::uint32_t a = std::uint32_t(one), b = std::uint32_t(other);
        if (!kernels::is_crack(samples_.x[a] - samples_.x[b], samples_.y[a] - samples_.y[b],
                               depth(one) - depth(other)))
            continue;
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
    for (const Crack &crack : cracks_) {
        front_[crack.cell] = crack.key;
        if (sees_images_) shown_[crack.cell] = crack.key;
    }
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
    see_opaque(lens, fillers_.samples, filler_bounds_, cells, filler_);
    for (const std::uint32_t cell : empty_) {
        std::uint64_t &filler = filler_[cell];
        if (filler != 0 &&
            hides(column_of(cell), row_of(cell), fillers_.samples.depth[std::uint32_t(filler)]))
            filler = 0;
    }
}

// The colour that the lens point sees of what is opaque in a cell, a filler included; null where that is unknown.
const float *LensTile::opaque_colour(std::size_t group, std::size_t cell) const {
    if (front_[cell] != 0) return &colours_.group(group)[std::size_t(std::uint32_t(shown()[cell])) * 4];
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
