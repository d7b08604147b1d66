#include "dof/lens/lens_tile.h"

#include "dof/lens/tile_projection.h"

#include <algorithm>
#include <array>
#include <limits>

namespace sparselens {

namespace {

using Colour4 = std::array<float, 4>;

template <typename Cells>
bool out_of_reach(const SampleBlock &b, const LensSample &lens, float x, float y, const Cells &cells) {
    const auto [x0, x1] = std::minmax({b.coc_min * lens.x, b.coc_max * lens.x});
    const auto [y0, y1] = std::minmax({b.coc_min * lens.y, b.coc_max * lens.y});
    return b.x_max + x1 + 1 < x + float(cells.left) || b.x_min + x0 - 1 > x + float(cells.right) ||
           b.y_max + y1 + 1 < y + float(cells.top) || b.y_min + y0 - 1 > y + float(cells.bottom);
}

} // namespace

LensTile::LensTile(const BlockedSamples &samples, const SampleColours &colours, const FillerSamples &fillers,
                   const Highlights &highlights, const HeldOut &held_out, const CatEye *cat_eye)
    : samples_(samples), colours_(colours), fillers_(fillers), highlights_(highlights), held_out_(held_out),
      cat_eye_(cat_eye), front_(stride * stride), filler_(stride * stride), empty_cells_(size * size),
      covered_cells_(stride * stride + 1), transmittance_(stride * stride, 1.0f), veil_(stride * stride),
      over_(colours.groups * stride * stride * 4), sums_(colours.groups * size * size * 4),
      spread_(sums_.size()), unknown_(size * size) {}

float LensTile::known_weight(int x, int y) const {
    const float known = total_ - unknown_[std::size_t(y * size + x)];
    return known > 1e-6f * total_ ? known : 0; // what rounding leaves of a weight is no knowledge
}

bool LensTile::dark(int x, int y) const {
    if (!weighted_ && known_weight(x, y) > 0) return false;
    for (std::size_t k = 0; k < colours_.groups * 4; ++k) {
        const std::size_t at = (k / 4 * size * size + std::size_t(y * size + x)) * 4 + k % 4;
        if ((weighted_ && known_of(at) > 0) || value(x, y, k) != 0) return false;
    }
    return true;
}

float LensTile::value(int x, int y, std::size_t channel) const {
    const std::size_t pixel = std::size_t(y * size + x),
                      at = (channel / 4 * size * size + pixel) * 4 + channel % 4;
    const float known = weighted_ ? known_of(at) : known_weight(x, y);
    return (known > 0 ? sums_[at] / known : 0) + spread_[at];
}

void LensTile::gather(const Imath::V2i &origin, const Blocks &blocks, std::span<const LensSample> lens,
                      std::span<const HighlightPixel> spread) {
    origin_x_ = float(origin.x);
    origin_y_ = float(origin.y);
    blocks_ = &blocks;
    collect_partial(lens);
    std::fill(sums_.begin(), sums_.end(), 0.0f);
    std::fill(spread_.begin(), spread_.end(), 0.0f);
    std::fill(unknown_.begin(), unknown_.end(), 0.0f);
    total_ = 0;
    begin_weighted(lens);
    has_veils_ = !spread.empty();
    for (std::uint32_t k = 0; k < lens.size(); ++k) {
        total_ += lens[k].weight;
        see_opaque(lens[k], samples_, blocks.samples, everywhere, front_);
        weighted_ ? list_empty() : add_opaque(lens[k].weight);
        find_cracks();
        see_fillers(lens[k]);
        close_cracks();
        see_partial(lens[k]);
        if (weighted_) {
            weigh_channels(lens[k]);
            find_columns(lens[k]);
            add_opaque_weighted();
            add_partial_weighted();
        } else {
            add_unseen(lens[k].weight);
            add_partial(lens[k].weight);
        }
        open_cracks(); // hides() has a rule of its own
        spread = add_highlights(spread, k);
        forget_partial();
    }
}

// The nearest opaque one in each of the cells.
void LensTile::see_opaque(const LensSample &lens, const BlockedSamples &samples,
                          std::span<const std::uint32_t> blocks, const Cells &seen,
                          std::vector<std::uint64_t> &front) const {
    std::fill(&front[cell_of(-border, seen.top)], &front[cell_of(-border, seen.bottom)], 0);
    const float x = origin_x_ - (border - 1), y = origin_y_ - (border - 1);
    const TileProjection projection(lens, x, y, stride);
    std::array<std::int32_t, 256> cells;
    for (const std::uint32_t b : blocks) {
        const SampleBlock &block = samples.blocks[b];
        if (out_of_reach(block, lens, origin_x_, origin_y_, seen)) continue;
        for (std::uint32_t begin = block.begin; begin < block.opaque_end;
             begin += std::uint32_t(cells.size())) {
            const std::uint32_t count = std::min(std::uint32_t(cells.size()), block.opaque_end - begin);
            project_to_cells(projection, &samples.x[begin], &samples.y[begin], &samples.coc[begin], count,
                             cells.data());
            const std::uint64_t *key = &samples.key[begin];
            for (std::uint32_t i = 0; i < count; ++i) {
                std::uint64_t &cell = front[std::size_t(cells[i])];
                cell = std::max(cell, key[i]);
            }
        }
    }
}

// Adds the picture that the lens point sees of the opaque samples, and lists the cells where it sees none.
void LensTile::add_opaque(float weight) {
    const bool held_out = held_out_.by != nullptr;
    std::size_t count = 0;
    for (std::size_t g = 0; g < colours_.groups; ++g) {
        const float *colours = colours_.group(g).data();
        for (int y = 0; y < size; ++y) {
            const std::uint64_t *front = &front_[cell_of(0, y)];
            float *sum = &sums_[(g * size * size + std::size_t(y * size)) * 4];
            for (int x = 0; x < size; ++x, sum += 4) {
                if (front[x] == 0) {
                    if (g == 0) empty_cells_[count++] = std::uint32_t(cell_of(x, y));
                    continue;
                }
                Colour4 colour; // a copy: the compiler need not fear that sum overlaps it
                std::copy_n(colours + std::size_t(std::uint32_t(front[x])) * 4, 4, colour.begin());
                const float share = held_out ? weight * opaque_passes(x, y) : weight;
                for (std::size_t k = 0; k < 4; ++k) sum[k] += share * colour[k];
            }
        }
    }
    empty_ = std::span(empty_cells_).first(count);
}

float LensTile::passes(int x, int y, float depth) const {
    const bool inside = x >= 0 && y >= 0 && x < size && y < size;
    if (!held_out_.by || !inside) return 1;
    const double z =
        depth > 0 ? held_out_.depth_at_1 / double(depth) : std::numeric_limits<double>::infinity();
    return float(held_out_.by->passes(held_out_.corner.x + int(origin_x_) + x,
                                      held_out_.corner.y + int(origin_y_) + y, z));
}

// Whether what lies at that depth is behind something in a cell, also where a surface is torn there: a crack one
// cell wide in what is drawn as points must not let a lamp through.
bool LensTile::hides(int x, int y, float depth) const {
    const std::uint64_t limit = depth_key(depth + float(one_surface_px), 0xffffffffu);
    const auto front = [&](int column, int row) { return front_[cell_of(column, row)] > limit; };
    return front(x, y) || (front(x - 1, y) && front(x + 1, y)) || (front(x, y - 1) && front(x, y + 1));
}

// Adds what lens point `lens` sees of the highlights and returns the pixels of the lens points after it.
std::span<const HighlightPixel> LensTile::add_highlights(std::span<const HighlightPixel> spread,
                                                         std::uint32_t lens) {
    std::size_t done = 0;
    for (; done < spread.size() && spread[done].lens == lens; ++done) {
        const HighlightPixel &p = spread[done];
        const std::size_t cell = cell_of(p.x, p.y), pixel = std::size_t(p.y * size + p.x);
        const std::uint32_t sample = highlights_.sample[p.highlight];
        if (hides(p.x, p.y, samples_.depth[sample])) continue;
        const Veil &veil = veil_[cell];
        const bool veiled =
            veil.transmittance < 1 && veil.depth > samples_.depth[sample] + float(one_surface_px);
        const float weight =
            p.weight * (veiled ? veil.transmittance : 1) * passes(p.x, p.y, samples_.depth[sample]);
        for (std::size_t g = 0; g < colours_.groups; ++g)
            for (std::size_t k = 0; k < 4; ++k)
                if (p.of & colours_.sets[g * 4 + k])
                    spread_[(g * size * size + pixel) * 4 + k] +=
                        weight * highlights_.light.group(g)[std::size_t(p.highlight) * 4 + k];
    }
    return spread.subspan(done);
}

} // namespace sparselens
