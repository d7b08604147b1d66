// What a lens point sees of the samples of partial coverage, front to back, before what is opaque.
#include "base/float4.h"
#include "dof/lens/lens_tile.h"
#include "dof/lens/tile_projection.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace sparselens {

namespace {

// Sorts by depth, the nearest first, then by index.
std::uint64_t order_key(float depth, std::uint32_t sample) {
    return (std::uint64_t(~std::bit_cast<std::uint32_t>(depth)) << 32) | sample;
}

} // namespace

// Whether a lens point can bring the sample into the tile, or into a pixel next to it.
bool LensTile::in_reach(std::uint32_t sample) const {
    const float coc = std::abs(samples_.coc[sample]), x = samples_.x[sample] - origin_x_,
                y = samples_.y[sample] - origin_y_;
    const float across = coc * reach_x_ + border, down = coc * reach_y_ + border;
    return x > -across && x < size + across && y > -down && y < size + down;
}

// Everything that see_partial() asks of a sample is copied into the order of its visits, as there are many.
void LensTile::collect_partial(std::span<const LensSample> lens) {
    reach_x_ = reach_y_ = 0;
    for (const LensSample &p : lens) {
        reach_x_ = std::max(reach_x_, std::abs(p.x));
        reach_y_ = std::max(reach_y_, std::abs(p.y));
    }
    auto &[order, sample, x, y, coc, left, key, colours, cell] = partial_;
    order.clear();
    for (const std::uint32_t b : blocks_->samples)
        for (std::uint32_t i = samples_.blocks[b].opaque_end; i < samples_.blocks[b].end; ++i)
            if (in_reach(i)) order.push_back(order_key(samples_.depth[i], i));
    std::sort(order.begin(), order.end());
    const std::size_t count = order.size();
    for (auto *array : {&x, &y, &coc, &left}) array->resize(count);
    sample.resize(count);
    key.resize(count);
    cell.resize(count);
    colours.resize(colours_.groups * count * 4);
    for (std::size_t n = 0; n < count; ++n) {
        const auto i = std::uint32_t(order[n]);
        sample[n] = i;
        x[n] = samples_.x[i];
        y[n] = samples_.y[i];
        coc[n] = samples_.coc[i];
        left[n] = 1 - samples_.alpha[i];
        key[n] = samples_.key[i];
        for (std::size_t g = 0; g < colours_.groups; ++g)
            std::copy_n(&colours_.group(g)[std::size_t(i) * 4], 4, &colours[(g * count + n) * 4]);
    }
}

void LensTile::see_partial(const LensSample &lens) {
    const TileProjection projection(lens, origin_x_ - (border - 1), origin_y_ - (border - 1), stride);
    project_to_cells(projection, partial_.x.data(), partial_.y.data(), partial_.coc.data(),
                     std::uint32_t(partial_.sample.size()), partial_.cell.data());
    const bool alone = !held_out_.by && !two_sided_ && colours_.groups == 1;
    covered_ = std::span(covered_cells_).first(alone ? see_partial_alone() : see_partial_by_rules());
}

// One group of channels and nothing else to heed: most pictures are, and most of the time goes here. Returns how many
// cells are covered.
std::size_t LensTile::see_partial_alone() {
    const std::size_t count = partial_.sample.size();
    const float *colour = partial_.colours.data(), *left = partial_.left.data();
    const std::uint64_t *key = partial_.key.data();
    const std::int32_t *cells = partial_.cell.data();
    std::size_t covered = 0;
    for (std::size_t n = 0; n < count; ++n, colour += 4) {
        const auto cell = std::size_t(cells[n]);
        if (key[n] < front_[cell]) continue;
        const float share = transmittance_[cell];
        covered_cells_[covered] = std::uint32_t(cell);
        covered += share == 1;
        float *over = &over_[cell * 4];
        store4(over, load4(over) + share * load4(colour));
        transmittance_[cell] = kernels::left_behind(share, left[n]);
    }
    return covered;
}

std::size_t LensTile::see_partial_by_rules() {
    const std::size_t count = partial_.sample.size();
    std::size_t covered = 0;
    for (std::size_t n = 0; n < count; ++n) {
        const std::uint32_t i = partial_.sample[n];
        const auto cell = std::size_t(partial_.cell[n]);
        if (partial_.key[n] < front_[cell]) continue;
        const float transmittance = transmittance_[cell];
        if (transmittance == 1) covered_cells_[covered++] = std::uint32_t(cell);
        const float share = held_out_.by
                                ? transmittance * passes(column_of(cell), row_of(cell), samples_.depth[i])
                                : transmittance;
        const std::size_t first_group = in_front(i) ? colours_.groups : 0;
        for (std::size_t g = 0; g < colours_.groups; ++g) {
            const float *colour = &partial_.colours[(g * count + n) * 4];
            float *over = &over_[((first_group + g) * stride * stride + cell) * 4];
            store4(over, load4(over) + share * load4(colour));
        }
        const float passed = kernels::left_behind(transmittance, partial_.left[n]);
        if (in_front(i)) hidden_in_front_[cell] += transmittance - passed;
        transmittance_[cell] = passed;
    }
    return covered;
}

// Puts the partial samples in front of what add_opaque() and add_unseen() added.
void LensTile::add_partial(float weight) {
    for (const std::uint32_t cell : covered_) {
        const int x = column_of(cell), y = row_of(cell);
        if (x < 0 || y < 0 || x >= size || y >= size) continue;
        const std::size_t pixel = std::size_t(y * size + x);
        const bool known = front_[cell] != 0 || filler_[cell] != 0;
        const float hidden = 1 - transmittance_[cell];
        if (!known) unknown_[pixel] -= weight * hidden;
        const float taken = !known ? 0 : held_out_.by ? hidden * opaque_passes(x, y) : hidden;
        for (std::size_t g = 0; g < colours_.groups; ++g) {
            const float *over = &over_[(g * stride * stride + cell) * 4];
            const float *behind = opaque_colour(g, cell);
            float *sum = &sums_[(g * size * size + pixel) * 4];
            const Float4 shown = known ? load4(over) - taken * load4(behind) : load4(over);
            store4(sum, load4(sum) + weight * shown);
        }
    }
}

void LensTile::forget_partial() {
    for (const std::uint32_t cell : covered_) {
        transmittance_[cell] = 1;
        if (two_sided_) hidden_in_front_[cell] = 0;
        for (std::size_t g = 0; g < (two_sided_ ? 2 : 1) * colours_.groups; ++g)
            std::fill_n(&over_[(g * stride * stride + cell) * 4], 4, 0.0f);
    }
    covered_ = {};
}

} // namespace sparselens
