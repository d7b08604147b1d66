// Lens points that weigh differently for R, G and B, for what lies behind focus and in front, or that not all pixels see
// through: what is known is summed up for each channel.
#include "base/float4.h"
#include "dof/lens/lens_tile.h"

#include <algorithm>

namespace sparselens {

namespace {

void add(double *to, Float4 values) {
    for (std::size_t k = 0; k < 4; ++k) to[k] += double(values[k]);
}

// Whether any sample of some blocks may lie in front of focus.
bool reaches_in_front(const BlockedSamples &samples, std::span<const std::uint32_t> blocks) {
    return std::ranges::any_of(blocks, [&](std::uint32_t b) {
        return samples.blocks[b].begin != samples.blocks[b].end && samples.blocks[b].coc_min < 0;
    });
}

} // namespace

void LensTile::begin_weighted(std::span<const LensSample> lens) {
    const bool rims =
        std::ranges::any_of(lens, [](const LensSample &p) { return p.behind != 1 || p.in_front != 1; });
    two_sided_ = rims && (reaches_in_front(samples_, blocks_->samples) ||
                          reaches_in_front(fillers_.samples, blocks_->fillers));
    weighted_ = cat_eye_ || rims || std::ranges::any_of(lens, [](const LensSample &p) {
                    return p.rgb[0] != 1 || p.rgb[1] != 1 || p.rgb[2] != 1;
                });
    if (!weighted_) return;
    known_.assign(sums_.size(), 0);
    steps_.assign(colours_.groups * counted_rows() * (size + 1) * 4, 0);
    for (auto *of : {&light_weights_, &known_weights_})
        for (auto &weights : *of) weights.resize(colours_.groups * 4);
    if (!two_sided_) return;
    over_.resize(2 * colours_.groups * stride * stride * 4);
    hidden_in_front_.resize(stride * stride);
    known_in_front_.assign(sums_.size(), 0);
}

float LensTile::known_of(std::size_t at) const {
    const float known = float(known_[at] + (two_sided_ ? double(known_in_front_[at]) : 0));
    return kernels::known_weight(known, total_);
}

void LensTile::find_columns(const LensSample &lens) {
    for (int y = 0; y < size; ++y)
        columns_[std::size_t(y)] = cat_eye_ ? cat_eye_->columns(lens, held_out_.corner.x + int(origin_x_),
                                                                size, held_out_.corner.y + int(origin_y_) + y)
                                            : CatEye::Columns{0, size};
}

bool LensTile::seen_by_none() const {
    return cat_eye_ &&
           std::ranges::all_of(columns_, [](const CatEye::Columns &c) { return c.begin >= c.end; });
}

void LensTile::weigh_channels(const LensSample &lens) {
    for (std::size_t k = 0; k < colours_.groups * 4; ++k) {
        for (const std::size_t side : {0u, 1u}) {
            light_weights_[side][k] =
                kernels::light_weight(colours_.sets[k], lens.weight, lens.rgb[0], lens.rgb[1], lens.rgb[2],
                                      side == 1 ? lens.in_front : lens.behind);
            known_weights_[side][k] = is_darkened(k) ? lens.weight : light_weights_[side][k];
        }
    }
}

// Counts the lens point as known, and behind focus, in all pixels that see through it.
void LensTile::count_columns() {
    for (std::size_t g = 0; g < colours_.groups; ++g) {
        const Float4 weight = load4(&known_weights_[0][g * 4]);
        double *row = &steps_[g * counted_rows() * (size + 1) * 4];
        for (const CatEye::Columns &seen : std::span(columns_).first(counted_rows())) {
            if (seen.begin < seen.end) {
                add(row + seen.begin * 4, weight);
                add(row + seen.end * 4, -weight);
            }
            row += (size + 1) * 4;
        }
    }
}

void LensTile::sum_up_known() {
    double *known = known_.data();
    for (std::size_t row = 0; row < colours_.groups * size; ++row) {
        const std::size_t counted = row / size * counted_rows() + row % size % counted_rows();
        const double *step = &steps_[counted * (size + 1) * 4];
        std::array<double, 4> sum{};
        for (int x = 0; x < size; ++x)
            for (std::size_t k = 0; k < 4; ++k) *known++ += sum[k] += *step++;
    }
}

// Backgrounds lie behind, wherever they are seen.
bool LensTile::opaque_in_front(std::size_t cell) const {
    if (!two_sided_) return false;
    const std::uint64_t key = shown()[cell];
    if (key != 0) return !is_background(key) && in_front(std::uint32_t(key));
    return filler_[cell] != 0 && fillers_.samples.coc[std::uint32_t(filler_[cell])] < 0;
}

// Adds what the lens point sees of the opaque samples, and lists the cells where it sees none.
void LensTile::add_opaque_weighted() {
    std::size_t empty = 0;
    for (int y = 0; y < size; ++y)
        two_sided_ ? add_row_weighted<true>(y, empty) : add_row_weighted<false>(y, empty);
    empty_ = std::span(empty_cells_).first(empty);
}

template <bool two_sided>
void LensTile::add_row_weighted(int y, std::size_t &empty) {
    const CatEye::Columns seen = columns_[std::size_t(y)];
    const bool held_out = held_out_.by != nullptr;
    const std::uint64_t *front = &shown()[cell_of(0, y)];
    const float *coc = samples_.coc.data();
    for (std::size_t g = 0; g < colours_.groups; ++g) {
        const float *colours = colours_.group(g).data();
        const Float4 behind = load4(&light_weights_[0][g * 4]), in_front = load4(&light_weights_[1][g * 4]),
                     more = known_in_front(g);
        const std::size_t row = (g * size * size + std::size_t(y * size)) * 4;
        float *sum = &sums_[row] + seen.begin * 4,
              *known = two_sided ? &known_in_front_[row] + seen.begin * 4 : nullptr;
        for (int x = seen.begin; x < seen.end; ++x, sum += 4, known += two_sided ? 4 : 0) {
            const std::uint64_t key = front[x];
            if (key == 0) {
                if (g == 0) empty_cells_[empty++] = std::uint32_t(cell_of(x, y));
                continue;
            }
            const std::size_t i = std::uint32_t(key);
            Float4 light = behind;
            if (two_sided && coc[i] < 0 && !is_background(key)) {
                light = in_front;
                store4(known, load4(known) + more);
            }
            if (held_out) light *= opaque_passes(x, y);
            store4(sum, load4(sum) + light * load4(colours + i * 4));
        }
    }
}

// How much more the lens point counts where it sees what lies in front of focus.
Float4 LensTile::known_in_front(std::size_t group) const {
    return load4(&known_weights_[1][group * 4]) - load4(&known_weights_[0][group * 4]);
}

void LensTile::count_in_front(std::size_t at, float share) {
    float *known = &known_in_front_[at];
    store4(known, load4(known) + share * known_in_front(at / (size * size * 4)));
}

// Adds what it sees of the empty cells: through cracks, and of fillers. What is behind the others is not known.
void LensTile::add_unseen_weighted() {
    for (const std::uint32_t cell : empty_) {
        const int x = column_of(cell), y = row_of(cell);
        const bool side = opaque_in_front(cell);
        for (std::size_t g = 0; g < colours_.groups; ++g) {
            const std::size_t at = (g * size * size + std::size_t(y * size + x)) * 4;
            const float *colour = opaque_colour(g, cell);
            if (colour) {
                const Float4 light = opaque_passes(x, y) * load4(&light_weights_[side][g * 4]);
                store4(&sums_[at], load4(&sums_[at]) + light * load4(colour));
                if (side) count_in_front(at, 1);
            } else {
                add(&known_[at], -load4(&known_weights_[0][g * 4]));
            }
        }
    }
}

// Puts the partial samples in front of what add_opaque_weighted() and add_unseen_weighted() added.
void LensTile::add_partial_weighted() {
    for (const std::uint32_t cell : covered_) {
        const int x = column_of(cell), y = row_of(cell);
        if (x < 0 || y < 0 || x >= size || y >= size || !in_columns(x, y)) continue;
        for (std::size_t g = 0; g < colours_.groups; ++g) add_partial_weighted(x, y, g);
    }
}

void LensTile::add_partial_weighted(int x, int y, std::size_t group) {
    const std::size_t cell = cell_of(x, y), at = (group * size * size + std::size_t(y * size + x)) * 4,
                      over = (group * stride * stride + cell) * 4;
    const auto light = [&](bool in_front) { return load4(&light_weights_[in_front][group * 4]); };
    const float hidden = 1 - transmittance_[cell], in_front = two_sided_ ? hidden_in_front_[cell] : 0;
    Float4 sum = load4(&sums_[at]) + light(false) * load4(&over_[over]);
    if (two_sided_) sum += light(true) * load4(&over_[over + colours_.groups * stride * stride * 4]);
    float share_in_front = in_front;
    if (const float *behind = opaque_colour(group, cell)) {
        const bool side = opaque_in_front(cell);
        sum -= hidden * opaque_passes(x, y) * light(side) * load4(behind);
        if (side) share_in_front -= hidden;
    } else {
        add(&known_[at], hidden * load4(&known_weights_[0][group * 4]));
    }
    store4(&sums_[at], sum);
    if (share_in_front != 0) count_in_front(at, share_in_front);
}

} // namespace sparselens
