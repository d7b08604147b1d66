// Lens points that weigh differently for R, G and B, for what lies behind focus and in front, or that not all pixels see
// through: what is known is summed up for each channel.
#include "dof/lens/lens_tile.h"

#include <algorithm>

namespace sparselens {

void LensTile::begin_weighted(std::span<const LensSample> lens) {
    two_sided_ =
        std::ranges::any_of(lens, [](const LensSample &p) { return p.behind != 1 || p.in_front != 1; });
    weighted_ = cat_eye_ || two_sided_ || std::ranges::any_of(lens, [](const LensSample &p) {
                    return p.rgb[0] != 1 || p.rgb[1] != 1 || p.rgb[2] != 1;
                });
    if (!weighted_) return;
    known_.assign(sums_.size(), 0);
    for (auto &weights : channel_weights_) weights.resize(colours_.groups * 4);
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
    }
}

void LensTile::find_columns(const LensSample &lens) {
    for (int y = 0; y < size; ++y)
        columns_[std::size_t(y)] = cat_eye_ ? cat_eye_->columns(lens, held_out_.corner.x + int(origin_x_),
                                                                size, held_out_.corner.y + int(origin_y_) + y)
                                            : CatEye::Columns{0, size};
}

bool LensTile::opaque_in_front(std::size_t cell) const {
    if (front_[cell] != 0) return in_front(std::uint32_t(front_[cell]));
    return two_sided_ && filler_[cell] != 0 && fillers_.samples.coc[std::uint32_t(filler_[cell])] < 0;
}

// The cells where the lens point sees nothing opaque.
void LensTile::list_empty() {
    std::size_t count = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            if (const std::size_t cell = cell_of(x, y); front_[cell] == 0)
                empty_cells_[count++] = std::uint32_t(cell);
    empty_ = std::span(empty_cells_).first(count);
}

// What is seen through cracks, and fillers, among it.
void LensTile::add_opaque_weighted() {
    const bool darkens = cat_eye_ && cat_eye_->darkens();
    for (std::size_t g = 0; g < colours_.groups; ++g)
        for (int y = 0; y < size; ++y) {
            const std::size_t row = (g * size * size + std::size_t(y * size)) * 4;
            for (int x = 0; x < size; ++x) {
                const std::size_t cell = cell_of(x, y);
                const bool passes_through = in_columns(x, y);
                if (!passes_through && !darkens) continue;
                const float *colour = opaque_colour(g, cell);
                if (!colour) continue;
                const float *weights = &channel_weights_[opaque_in_front(cell)][g * 4];
                const float share = held_out_.by ? opaque_passes(x, y) : 1;
                for (std::size_t k = 0; k < 4; ++k) {
                    const std::size_t at = row + std::size_t(x) * 4 + k;
                    if (passes_through || !is_darkened(g * 4 + k))
                        sums_[at] += share * weights[k] * colour[k];
                    known_[at] += weights[k];
                }
            }
        }
}

// Puts the partial samples in front of what add_opaque_weighted() added.
void LensTile::add_partial_weighted() {
    const bool darkens = cat_eye_ && cat_eye_->darkens();
    const std::size_t side_size = colours_.groups * stride * stride * 4;
    for (const std::uint32_t cell : covered_) {
        const int x = column_of(cell), y = row_of(cell);
        if (x < 0 || y < 0 || x >= size || y >= size) continue;
        const bool passes_through = in_columns(x, y);
        if (!passes_through && !darkens) continue;
        const bool known = opaque_colour(0, cell) != nullptr;
        const float hidden = 1 - transmittance_[cell],
                    hidden_in_front = two_sided_ ? hidden_in_front_[cell] : 0;
        const float taken = known ? hidden * opaque_passes(x, y) : 0;
        for (std::size_t k = 0; k < colours_.groups * 4; ++k) {
            const std::size_t at = (k / 4 * size * size + std::size_t(y * size + x)) * 4 + k % 4,
                              over = (k / 4 * stride * stride + cell) * 4 + k % 4;
            const float behind = channel_weights_[0][k], in_front_of = channel_weights_[1][k];
            const float weight = known ? channel_weights_[opaque_in_front(cell)][k] : 0;
            known_[at] +=
                behind * (hidden - hidden_in_front) + in_front_of * hidden_in_front - weight * hidden;
            if (!passes_through && is_darkened(k)) continue;
            sums_[at] += behind * over_[over] + (two_sided_ ? in_front_of * over_[side_size + over] : 0);
            if (known) sums_[at] -= weight * taken * opaque_colour(k / 4, cell)[k % 4];
        }
    }
}

} // namespace sparselens
