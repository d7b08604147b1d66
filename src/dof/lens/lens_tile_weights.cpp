// Lens points that weigh differently for R, G and B, for what lies behind focus and in front, or that not all pixels see
// through: what is known is summed up for each channel.
#include "dof/lens/lens_tile.h"

#include <algorithm>

namespace sparselens {

namespace {

using Four = std::array<float, 4>;

Four four(const float *values) {
    Four copy;
    std::copy_n(values, 4, copy.begin());
    return copy;
}

} // namespace

void LensTile::begin_weighted(std::span<const LensSample> lens) {
    two_sided_ =
        std::ranges::any_of(lens, [](const LensSample &p) { return p.behind != 1 || p.in_front != 1; });
    weighted_ = cat_eye_ || two_sided_ || std::ranges::any_of(lens, [](const LensSample &p) {
                    return p.rgb[0] != 1 || p.rgb[1] != 1 || p.rgb[2] != 1;
                });
    if (!weighted_) return;
    known_.assign(sums_.size(), 0);
    for (auto *of : {&channel_weights_, &dark_weights_})
        for (auto &weights : *of) weights.resize(colours_.groups * 4);
    if (!two_sided_) return;
    over_.resize(2 * colours_.groups * stride * stride * 4);
    hidden_in_front_.resize(stride * stride);
}

float LensTile::known_of(std::size_t at) const { return known_[at] > 1e-6f * total_ ? known_[at] : 0; }

// Data takes no part: what has no colour is the same for all light.
void LensTile::weigh_channels(const LensSample &lens) {
    for (std::size_t k = 0; k < colours_.groups * 4; ++k) {
        const ColourSet set = colours_.sets[k];
        const float colour = set == red     ? lens.rgb[0]
                             : set == green ? lens.rgb[1]
                             : set == blue  ? lens.rgb[2]
                                            : 1;
        channel_weights_[0][k] = lens.weight * colour * (set == data ? 1 : lens.behind);
        channel_weights_[1][k] = lens.weight * colour * (set == data ? 1 : lens.in_front);
        for (const std::size_t side : {0u, 1u})
            dark_weights_[side][k] = is_darkened(k) ? 0 : channel_weights_[side][k];
    }
}

void LensTile::find_columns(const LensSample &lens) {
    for (int y = 0; y < size; ++y)
        columns_[std::size_t(y)] = cat_eye_ ? cat_eye_->columns(lens, held_out_.corner.x + int(origin_x_),
                                                                size, held_out_.corner.y + int(origin_y_) + y)
                                            : CatEye::Columns{0, size};
}

bool LensTile::seen_by_none() const {
    return cat_eye_ && !cat_eye_->darkens() &&
           std::ranges::all_of(columns_, [](const CatEye::Columns &c) { return c.begin >= c.end; });
}

// Backgrounds lie behind, wherever they are seen.
bool LensTile::opaque_in_front(std::size_t cell) const {
    if (!two_sided_) return false;
    const std::uint64_t key = shown()[cell];
    if (key != 0) return key > nearest_background && in_front(std::uint32_t(key));
    return filler_[cell] != 0 && fillers_.samples.coc[std::uint32_t(filler_[cell])] < 0;
}

// Adds what the lens point sees of the opaque samples, and lists the cells where it sees none.
void LensTile::add_opaque_weighted() {
    const bool darkens = cat_eye_ && cat_eye_->darkens();
    std::size_t empty = 0;
    for (int y = 0; y < size; ++y) {
        const CatEye::Columns seen = columns_[std::size_t(y)];
        add_row_weighted(y, seen, channel_weights_, empty);
        if (!darkens) continue;
        add_row_weighted(y, {0, seen.begin}, dark_weights_, empty);
        add_row_weighted(y, {std::max(seen.begin, seen.end), size}, dark_weights_, empty);
    }
    empty_ = std::span(empty_cells_).first(empty);
}

// Copies of four values: the compiler need not fear that sums overlap them.
void LensTile::add_row_weighted(int y, CatEye::Columns columns, const Weights &lit, std::size_t &empty) {
    const bool held_out = held_out_.by != nullptr, two_sided = two_sided_;
    const std::uint64_t *front = &shown()[cell_of(0, y)];
    const float *coc = samples_.coc.data();
    for (std::size_t g = 0; g < colours_.groups; ++g) {
        const float *colours = colours_.group(g).data();
        const std::array weights{four(&channel_weights_[0][g * 4]), four(&channel_weights_[1][g * 4])},
            lights{four(&lit[0][g * 4]), four(&lit[1][g * 4])};
        const std::size_t row = (g * size * size + std::size_t(y * size)) * 4;
        float *sums = &sums_[row], *knowns = &known_[row];
        for (int x = columns.begin; x < columns.end; ++x) {
            if (front[x] == 0) {
                if (g == 0) empty_cells_[empty++] = std::uint32_t(cell_of(x, y));
                continue;
            }
            const std::uint32_t i = std::uint32_t(front[x]);
            const bool side = two_sided && front[x] > nearest_background && coc[i] < 0;
            const float share = held_out ? opaque_passes(x, y) : 1;
            const Four colour = four(colours + std::size_t(i) * 4), light = lights[side],
                       weight = weights[side];
            Four sum = four(sums + x * 4), known = four(knowns + x * 4);
            for (std::size_t k = 0; k < 4; ++k) sum[k] += share * light[k] * colour[k];
            for (std::size_t k = 0; k < 4; ++k) known[k] += weight[k];
            std::ranges::copy(sum, sums + x * 4);
            std::ranges::copy(known, knowns + x * 4);
        }
    }
}

// Adds what it sees of the empty cells: through cracks, and of fillers.
void LensTile::add_unseen_weighted() {
    for (const std::uint32_t cell : empty_) {
        const int x = column_of(cell), y = row_of(cell);
        const Weights &lit = in_columns(x, y) ? channel_weights_ : dark_weights_;
        const bool side = opaque_in_front(cell);
        for (std::size_t g = 0; g < colours_.groups; ++g) {
            const float *colour = opaque_colour(g, cell);
            if (!colour) continue;
            const std::size_t at = (g * size * size + std::size_t(y * size + x)) * 4;
            for (std::size_t k = 0; k < 4; ++k) {
                sums_[at + k] += opaque_passes(x, y) * lit[side][g * 4 + k] * colour[k];
                known_[at + k] += channel_weights_[side][g * 4 + k];
            }
        }
    }
}

// Puts the partial samples in front of what add_opaque_weighted() and add_unseen_weighted() added.
void LensTile::add_partial_weighted() {
    const bool darkens = cat_eye_ && cat_eye_->darkens();
    for (const std::uint32_t cell : covered_) {
        const int x = column_of(cell), y = row_of(cell);
        if (x < 0 || y < 0 || x >= size || y >= size) continue;
        if (!darkens && !in_columns(x, y)) continue;
        for (std::size_t g = 0; g < colours_.groups; ++g) add_partial_weighted(x, y, g);
    }
}

void LensTile::add_partial_weighted(int x, int y, std::size_t group) {
    const std::size_t cell = cell_of(x, y), at = (group * size * size + std::size_t(y * size + x)) * 4,
                      over = (group * stride * stride + cell) * 4;
    const auto weights = [&](const auto &of, bool in_front) { return four(&of[in_front][group * 4]); };
    const auto &lit = in_columns(x, y) ? channel_weights_ : dark_weights_;
    float *sum = &sums_[at], *known = &known_[at];
    const auto add = [&](bool in_front, float covered, const Four &colour) {
        const Four weight = weights(channel_weights_, in_front), light = weights(lit, in_front);
        for (std::size_t k = 0; k < 4; ++k) sum[k] += light[k] * colour[k];
        for (std::size_t k = 0; k < 4; ++k) known[k] += weight[k] * covered;
    };
    const float hidden = 1 - transmittance_[cell], in_front = two_sided_ ? hidden_in_front_[cell] : 0;
    add(false, hidden - in_front, four(&over_[over]));
    if (two_sided_) add(true, in_front, four(&over_[over + colours_.groups * stride * stride * 4]));
    const float *behind = opaque_colour(group, cell);
    if (!behind) return;
    Four taken = four(behind);
    for (float &v : taken) v *= -hidden * opaque_passes(x, y);
    add(opaque_in_front(cell), -hidden, taken);
}

} // namespace sparselens
