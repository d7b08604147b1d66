#include "dof/lens/lens_tile.h"

#include "base/float4.h"
#include "dof/lens/tile_projection.h"

#include <algorithm>
#include <array>
#include <limits>

namespace sparselens {

LensTile::LensTile(const BlockedSamples &samples, const SampleColours &colours, const PlacedFacets &facets,
                   const FillerSamples &fillers, const HeldOut &held_out, const CatEye *cat_eye)
    : samples_(samples), colours_(colours), facets_(facets), fillers_(fillers), held_out_(held_out),
      cat_eye_(cat_eye), front_(stride * stride), filler_(stride * stride), empty_cells_(size * size),
      covered_cells_(stride * stride + 1), transmittance_(stride * stride, 1.0f),
      over_(colours.groups * stride * stride * 4), sums_(colours.groups * size * size * 4),
      unknown_(size * size) {}

float LensTile::known_weight(int x, int y) const {
    const float known = total_ - unknown_[std::size_t(y * size + x)];
    return kernels::known_weight(known, total_);
}

bool LensTile::known(int x, int y) const {
    if (!weighted_) return known_weight(x, y) > 0;
    for (std::size_t k = 0; k < colours_.groups * 4; ++k)
        if (known_of((k / 4 * size * size + std::size_t(y * size + x)) * 4 + k % 4) > 0) return true;
    return false;
}

float LensTile::value(int x, int y, std::size_t channel) const {
    const std::size_t pixel = std::size_t(y * size + x),
                      at = (channel / 4 * size * size + pixel) * 4 + channel % 4;
    const float known = weighted_ ? known_of(at) : known_weight(x, y);
    return known > 0 ? sums_[at] / known : 0;
}

void LensTile::gather(const Imath::V2i &origin, const Blocks &blocks, std::span<const LensSample> lens) {
    origin_x_ = float(origin.x);
    origin_y_ = float(origin.y);
    blocks_ = &blocks;
    bounds_.set(blocks.samples, samples_);
    filler_bounds_.set(blocks.fillers, fillers_.samples);
    collect_partial(lens);
    std::fill(sums_.begin(), sums_.end(), 0.0f);
    std::fill(unknown_.begin(), unknown_.end(), 0.0f);
    total_ = 0;
    begin_weighted(lens);
    for (const LensSample &point : lens) {
        total_ += point.weight;
        if (weighted_) find_columns(point);
        if (seen_by_none()) continue;
        see_opaque(point, samples_, bounds_, everywhere, front_);
        see_facets(point);
        see_images(point);
        if (weighted_) {
            weigh_channels(point);
            count_columns();
        }
        weighted_ ? add_opaque_weighted() : add_opaque(point.weight);
        find_cracks();
        see_fillers(point);
        close_cracks();
        see_partial(point);
        if (weighted_) {
            add_unseen_weighted();
            add_partial_weighted();
        } else {
            add_unseen(point.weight);
            add_partial(point.weight);
        }
        forget_partial();
    }
    if (weighted_) sum_up_known();
}

// The nearest opaque one in each of the cells.
void LensTile::see_opaque(const LensSample &lens, const BlockedSamples &samples, BlockBounds &bounds,
                          const Cells &seen, std::vector<std::uint64_t> &front) const {
    std::fill(&front[cell_of(-border, seen.top)], &front[cell_of(-border, seen.bottom)], 0);
    const float x = origin_x_ - (border - 1), y = origin_y_ - (border - 1);
    const TileProjection projection(lens, x, y, stride);
    std::array<std::int32_t, 256> cells;
    const std::vector<float> &coc = samples.hiding_coc();
    const BlockBounds::Box box{origin_x_ + float(seen.left), origin_x_ + float(seen.right),
                               origin_y_ + float(seen.top), origin_y_ + float(seen.bottom)};
    for (const std::uint32_t b : bounds.reached(lens, box)) {
        const SampleBlock &block = samples.blocks[b];
        for (std::uint32_t begin = block.begin; begin < block.opaque_end;
             begin += std::uint32_t(cells.size())) {
            const std::uint32_t count = std::min(std::uint32_t(cells.size()), block.opaque_end - begin);
            project_to_cells(projection, &samples.x[begin], &samples.y[begin], &coc[begin], count,
                             cells.data());
            const std::uint64_t *key = &samples.key[begin];
            for (std::uint32_t i = 0; i < count; ++i) {
                std::uint64_t &cell = front[std::size_t(cells[i])];
                cell = std::max(cell, key[i]);
            }
        }
    }
}

// What lies between the samples of steep surfaces.
void LensTile::see_facets(const LensSample &lens) {
    const FacetGrid grid{origin_x_ - (border - 1), origin_y_ - (border - 1), stride};
    draw_facets(facets_, blocks_->facets, lens, grid, front_);
}

// Adds the picture that the lens point sees of the opaque samples, and lists the cells where it sees none.
void LensTile::add_opaque(float weight) {
    const bool held_out = held_out_.by != nullptr;
    std::size_t count = 0;
    for (std::size_t g = 0; g < colours_.groups; ++g) {
        const float *colours = colours_.group(g).data();
        for (int y = 0; y < size; ++y) {
            const std::uint64_t *front = &shown()[cell_of(0, y)];
            float *sum = &sums_[(g * size * size + std::size_t(y * size)) * 4];
            for (int x = 0; x < size; ++x, sum += 4) {
                if (front[x] == 0) {
                    if (g == 0) empty_cells_[count++] = std::uint32_t(cell_of(x, y));
                    continue;
                }
                const float share = held_out ? weight * opaque_passes(x, y) : weight;
                store4(sum, load4(sum) + share * load4(colours + std::size_t(std::uint32_t(front[x])) * 4));
            }
        }
    }
    empty_ = std::span(empty_cells_).first(count);
}

float HeldOut::passes(const Imath::V2i &pixel, float depth) const {
    const double z = depth > 0 ? depth_at_1 / double(depth) : std::numeric_limits<double>::infinity();
    return float(by->passes(corner.x + pixel.x, corner.y + pixel.y, z));
}

float LensTile::passes(int x, int y, float depth) const {
    const bool inside = x >= 0 && y >= 0 && x < size && y < size;
    if (!held_out_.by || !inside) return 1;
    return held_out_.passes({int(origin_x_) + x, int(origin_y_) + y}, depth);
}

// Whether what lies at that depth is behind something in a cell, also where a surface is torn there.
bool LensTile::hides(int x, int y, float depth) const {
    const std::uint64_t limit = kernels::hiding_key(depth);
    const auto front = [&](int column, int row) { return front_[cell_of(column, row)] > limit; };
    return front(x, y) || (front(x - 1, y) && front(x + 1, y)) || (front(x, y - 1) && front(x, y + 1));
}

} // namespace sparselens
