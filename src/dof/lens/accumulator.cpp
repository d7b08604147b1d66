#include "dof/lens/accumulator.h"

#include "dof/lens/cell_rows.h"
#include "kernels/lens_rules.h"

#include <algorithm>
#include <type_traits>
#include <utility>

namespace sparselens {

using namespace tile_cells;

namespace {

constexpr bool in_tile(int x, int y) { return x >= 0 && y >= 0 && x < size && y < size; }
std::size_t pixel_of(std::size_t cell) { return std::size_t(row(cell) * size + column(cell)); }

} // namespace

LensWeights::LensWeights(const GatherScene &scene)
    : scene_(scene), totals_(scene.colours.groups * 4), lost_(totals_.size() * pixels) {
    for (auto *of : {&light_, &weight_})
        for (auto &of_point : *of) of_point.fill(std::vector<float>(totals_.size()));
}

void LensWeights::count(std::size_t l, const LensSample &point) {
    total_ += point.weight;
    for (std::size_t k = 0; k < totals_.size(); ++k) {
        const ColourSet set = scene_.colours.sets[k];
        const bool darkened = kernels::is_darkened(set, scene_.cat_eye() && scene_.cat_eye()->darkens());
        for (const std::size_t side : {0u, 1u}) {
            const ColourFactors &rgb = point.rgb, &of_side = side == 1 ? point.in_front : point.behind;
            light_[l][side][k] = kernels::light_weight(
                set, point.weight, kernels::of_colour(set, rgb[0], rgb[1], rgb[2], 1),
                kernels::of_colour(set, of_side[0], of_side[1], of_side[2], of_side[1]));
            weight_[l][side][k] = darkened ? point.weight : light_[l][side][k];
        }
        totals_[k] += weight_[l][0][k];
    }
}

void LensWeights::lose(std::size_t l, std::size_t pixel, float share) {
    for (std::size_t k = 0; k < totals_.size(); k += 4) {
        float *lost = &lost_[(k * pixels) + pixel * 4];
        store4(lost, load4(lost) + share * load4(&weight_[l][0][k]));
    }
}

void LensWeights::put_in_front(std::size_t l, std::size_t pixel, float share) {
    for (std::size_t k = 0; k < totals_.size(); k += 4) {
        float *lost = &lost_[(k * pixels) + pixel * 4];
        store4(lost, load4(lost) + share * (load4(&weight_[l][0][k]) - load4(&weight_[l][1][k])));
    }
}

std::vector<float> LensWeights::known() const {
    std::vector<float> known(lost_.size());
    for (std::size_t n = 0; n < known.size(); ++n)
        known[n] = kernels::known_weight(totals_[n / (pixels * 4) * 4 + n % 4] - lost_[n], total_);
    return known;
}

Accumulator::Accumulator(const GatherScene &scene, const TileSamples &samples, const Imath::V2i &origin,
                         bool two_sided)
    : samples_(samples), origin_(origin), held_out_(scene.held_out), sides_(two_sided ? 2 : 1),
      groups_(scene.colours.groups), weights_(scene), left_(count, 1.0f), over_(sides_ * groups_ * count * 4),
      in_front_(two_sided ? count : 0), covered_cells_(count + 1), sums_(groups_ * pixels * 4),
      known_(groups_ * pixels) {
    for (std::size_t g = 0; g < groups_; ++g)
        for (const std::uint32_t i : samples.partial.sample) {
            const float *colour = &scene.colours.group(g)[std::size_t(i) * 4];
            partial_.insert(partial_.end(), colour, colour + 4);
        }
}

void Accumulator::add(const Visibility &seen, const LensSample &point) {
    const std::size_t l = waiting_count_;
    weights_.count(l, point);
    seen.for_each_unknown([&](std::size_t cell) { weights_.lose(l, pixel_of(cell), 1); });
    cover(seen);
    add_covered(l, seen);
    uncover();
    waiting_[waiting_count_++] = &seen;
    if (waiting_count_ == waiting_.size()) add_opaque();
}

void Accumulator::add_opaque() {
    static constexpr std::array<CellWord, size> nothing{};
    const std::span<const Visibility *const> seen =
        std::span(waiting_).first(std::exchange(waiting_count_, 0));
    for (std::size_t g = 0; g < groups_ && !seen.empty(); ++g)
        for (int y = 0; y < seen.front()->rows; ++y) {
            if (sides_ > 1 || held_out_.by) {
                for (std::size_t l = 0; l < seen.size(); ++l) add_row(l, *seen[l], g, y);
                continue;
            }
            std::array<const CellWord *, points_at_once> rows;
            std::array<Float4, points_at_once> factors{};
            rows.fill(nothing.data());
            for (std::size_t l = 0; l < seen.size(); ++l) {
                rows[l] = &seen[l]->shown()[at(0, y)];
                factors[l] = weights_.of(l, g, 0);
            }
            add_rows(&sums_[(g * pixels + std::size_t(y * size)) * 4], rows, factors,
                     samples_.colours(g).data(), samples_.number_mask(), (seen.front()->rows + 1) / 2 * 2);
        }
}

// The same for one lens point that counts differently for each sample.
void Accumulator::add_row(std::size_t l, const Visibility &seen, std::size_t group, int y) {
    for (int x = 0; x < seen.rows; ++x) {
        const std::size_t cell = at(x, y), pixel = pixel_of(cell);
        const std::uint32_t number = samples_.number_of(seen.shown()[cell]);
        if (number == 0) continue;
        const std::size_t side = side_of(number);
        float *sum = &sums_[(group * pixels + pixel) * 4];
        store4(sum,
               load4(sum) + opaque_passes(seen, cell) * weights_.of(l, group, side) * colour(group, number));
        if (side > 0 && group == 0) weights_.put_in_front(l, pixel, 1);
    }
}

// Composites the partial samples. Most pictures have one group of channels, and most of their time goes here.
void Accumulator::cover(const Visibility &seen) {
    const auto all = [](std::size_t, std::size_t) { return 1.0f; };
    const auto held_out = [&](std::size_t n, std::size_t cell) {
        return passes(cell, samples_.partial.depth[n]);
    };
    const auto by = [&](auto groups) {
        held_out_.by ? cover_by(seen, groups, held_out) : cover_by(seen, groups, all);
    };
    groups_ == 1 ? by(std::integral_constant<std::size_t, 1>()) : by(groups_);
}

template <typename Groups, typename Passes>
void Accumulator::cover_by(const Visibility &seen, Groups groups, const Passes &passed) {
    const PartialSamples &partial = samples_.partial;
    const std::size_t samples = partial.count();
    const std::uint16_t *cells = seen.partial_cells.data();
    const CellWord *words = partial.placed.words.data(), *front = seen.front.data();
    const CellWord mask = samples_.number_mask();
    const float *depths = partial.depth.data(), *leaves = partial.left.data(), *coc = partial.coc.data(),
                *colours = partial_.data();
    float *lefts = left_.data(), *over = over_.data();
    std::uint32_t *covered = covered_cells_.data();
    const bool two_sided = sides_ > 1;
    for (std::size_t n = 0; n < samples; ++n) {
        const auto cell = std::size_t(cells[n]);
        if (words[n] - front[cell] <= mask &&
            (words[n] < front[cell] || depths[n] < samples_.shown[std::size_t(front[cell] & mask)].depth))
            continue; // behind it; samples of one code are compared by their depth
        const float left = lefts[cell], share = left * passed(n, cell);
        const std::size_t side = two_sided && coc[n] < 0 ? 1 : 0;
        *covered = std::uint32_t(cell);
        covered += left == 1;
        for (std::size_t g = 0; g < groups; ++g) {
            float *sum = over + ((side * groups + g) * count + cell) * 4;
            store4(sum, load4(sum) + share * load4(colours + (g * samples + n) * 4));
        }
        lefts[cell] = kernels::left_behind(left, leaves[n]);
        if (side > 0) in_front_[cell] += left - lefts[cell];
    }
    covered_ = std::span(covered_cells_.data(), covered);
}

// Puts the partial samples in front of what add_opaque() adds.
void Accumulator::add_covered(std::size_t l, const Visibility &seen) {
    const CellWord *shown = seen.shown().data();
    for (const std::uint32_t cell : covered_) {
        const int x = column(cell), y = row(cell);
        if (!in_tile(x, y) || !seen.sees_through(x, y)) continue;
        const std::size_t pixel = pixel_of(cell);
        const std::uint32_t behind = samples_.number_of(shown[cell]);
        const std::size_t side_behind = side_of(behind);
        const float hidden = 1 - left_[cell], taken = hidden * opaque_passes(seen, cell);
        if (behind == 0) weights_.lose(l, pixel, -hidden);
        for (std::size_t g = 0; g < groups_; ++g) {
            Float4 light = -taken * weights_.of(l, g, side_behind) * colour(g, behind);
            for (std::size_t side = 0; side < sides_; ++side)
                light += weights_.of(l, g, side) * load4(&over_[((side * groups_ + g) * count + cell) * 4]);
            float *sum = &sums_[(g * pixels + pixel) * 4];
            store4(sum, load4(sum) + light);
        }
        if (sides_ > 1) weights_.put_in_front(l, pixel, in_front_[cell] - (side_behind > 0 ? hidden : 0));
    }
}

void Accumulator::uncover() {
    for (const std::uint32_t cell : covered_) {
        left_[cell] = 1;
        if (sides_ > 1) in_front_[cell] = 0;
        for (std::size_t n = 0; n < sides_ * groups_; ++n) store4(&over_[(n * count + cell) * 4], Float4{});
    }
    covered_ = {};
}

TilePicture Accumulator::picture() {
    add_opaque();
    const std::vector<float> known = weights_.known();
    for (std::size_t n = 0; n < known.size(); ++n) {
        sums_[n] = known[n] > 0 ? sums_[n] / known[n] : 0;
        known_[n / 4] = std::max(known_[n / 4], known[n]);
    }
    return {sums_.data(), known_.data(), groups_, pixels * 4};
}

float Accumulator::passes(std::size_t cell, float depth) const {
    const int x = column(cell), y = row(cell);
    return in_tile(x, y) ? held_out_.passes(origin_ + Imath::V2i(x, y), depth) : 1;
}

float Accumulator::opaque_passes(const Visibility &seen, std::size_t cell) const {
    if (!held_out_.by || seen.front[cell] == 0) return 1;
    return passes(cell, samples_.shown[samples_.number_of(seen.front[cell])].depth);
}

} // namespace sparselens
