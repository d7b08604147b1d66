#include "dof/lens/accumulator.h"

#include "kernels/lens_rules.h"

#include <algorithm>
#include <type_traits>

namespace sparselens {

using namespace tile_cells;

namespace {

constexpr bool in_tile(int x, int y) { return x >= 0 && y >= 0 && x < size && y < size; }
std::size_t pixel_of(std::size_t cell) { return std::size_t(row(cell) * size + column(cell)); }

} // namespace

template <typename Light>
Accumulator<Light>::Accumulator(const GatherScene &scene, const Visibility &tile)
    : scene_(scene), held_out_(scene.held_out), light_(scene), left_(count, 1.0f),
      over_(Light::sides * scene.colours.groups * count * 4), in_front_(Light::sides > 1 ? count : 0),
      covered_cells_(count + 1), sums_(scene.colours.groups * pixels * 4), known_(sums_.size() / 4) {
    for (std::size_t g = 0; g < scene.colours.groups; ++g)
        for (const std::uint32_t i : tile.partial.sample) {
            const float *colour = &scene.colours.group(g)[std::size_t(i) * 4];
            partial_.insert(partial_.end(), colour, colour + 4);
        }
}

template <typename Light>
void Accumulator<Light>::add(const Visibility &seen, const LensSample &point) {
    light_.count(point, seen);
    add_opaque(seen);
    add_fillers(seen);
    cover(seen);
    add_covered(seen);
    uncover();
}

template <typename Light>
void Accumulator<Light>::add_opaque(const Visibility &seen) {
    const bool held_out = held_out_.by != nullptr;
    for (std::size_t g = 0; g < scene_.colours.groups; ++g) {
        const float *colours = scene_.colours.group(g).data();
        const Float4 behind = light_.of(g, 0), in_front = light_.of(g, Light::sides - 1);
        for (int y = 0; y < seen.rows; ++y) {
            const auto [begin, end] = seen.columns[std::size_t(y)];
            const std::uint64_t *row_keys = &seen.shown()[at(0, y)];
            float *row_sums = &sums_[(g * pixels + std::size_t(y * size)) * 4];
            for (std::ptrdiff_t x = begin; x < end; ++x) {
                const std::uint64_t key = row_keys[x];
                if (key == 0) continue;
                const std::size_t side = side_of(key);
                Float4 light = side > 0 ? in_front : behind;
                if (held_out) light *= opaque_passes(seen, at(int(x), y));
                float *sum = row_sums + x * 4;
                store4(sum, load4(sum) + light * load4(colours + std::size_t(std::uint32_t(key)) * 4));
                if (side > 0 && g == 0) light_.put_in_front(std::size_t(y * size + x), 1);
            }
        }
    }
}

// The background of empty cells without a filler is unknown.
template <typename Light>
void Accumulator<Light>::add_fillers(const Visibility &seen) {
    seen.for_each_empty([&](std::size_t cell) {
        const std::size_t pixel = pixel_of(cell);
        const Opaque filler = opaque_at(seen, cell);
        if (!filler.colours) return light_.lose(pixel, 1);
        const float passed = opaque_passes(seen, cell);
        for (std::size_t g = 0; g < scene_.colours.groups; ++g) {
            float *sum = &sums_[(g * pixels + pixel) * 4];
            store4(sum, load4(sum) + passed * light_.of(g, filler.side) * filler.colour(g));
        }
        if (filler.side > 0) light_.put_in_front(pixel, 1);
    });
}

// Composites the partial samples. Most pictures have one group of channels, and most of their time goes here.
template <typename Light>
void Accumulator<Light>::cover(const Visibility &seen) {
    const auto all = [](std::size_t, std::size_t) { return 1.0f; };
    const auto held_out = [&](std::size_t n, std::size_t cell) {
        return passes(seen, cell, seen.partial.depth[n]);
    };
    const auto by = [&](auto groups) {
        held_out_.by ? cover_by(seen, groups, held_out) : cover_by(seen, groups, all);
    };
    scene_.colours.groups == 1 ? by(std::integral_constant<std::size_t, 1>()) : by(scene_.colours.groups);
}

template <typename Light>
template <typename Groups, typename Passes>
void Accumulator<Light>::cover_by(const Visibility &seen, Groups groups, const Passes &passed) {
    const PartialSamples &partial = seen.partial;
    const std::size_t samples = partial.count();
    const std::int32_t *cells = seen.partial_cells.data();
    const std::uint64_t *key = partial.key.data(), *front = seen.front.data();
    const float *leaves = partial.left.data(), *coc = partial.coc.data(), *colours = partial_.data();
    float *lefts = left_.data(), *over = over_.data();
    std::uint32_t *covered = covered_cells_.data();
    for (std::size_t n = 0; n < samples; ++n) {
        const auto cell = std::size_t(cells[n]);
        if (key[n] < front[cell]) continue;
        const float left = lefts[cell], share = left * passed(n, cell);
        const std::size_t side = Light::sides > 1 && coc[n] < 0 ? 1 : 0;
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

// Puts the partial samples in front of what add_opaque() and add_fillers() added.
template <typename Light>
void Accumulator<Light>::add_covered(const Visibility &seen) {
    const std::size_t groups = scene_.colours.groups;
    for (const std::uint32_t cell : covered_) {
        const int x = column(cell), y = row(cell);
        if (!in_tile(x, y) || !seen.sees_through(x, y)) continue;
        const auto pixel = std::size_t(y * size + x);
        const Opaque behind = opaque_at(seen, cell);
        const float hidden = 1 - left_[cell];
        if (!behind.colours) light_.lose(pixel, -hidden);
        Covered covered{{}, behind.colours ? hidden * opaque_passes(seen, cell) : 0, {}, behind.side};
        for (std::size_t g = 0; g < groups; ++g) {
            for (std::size_t side = 0; side < Light::sides; ++side)
                covered.over[side] = load4(&over_[((side * groups + g) * count + cell) * 4]);
            if (behind.colours) covered.behind = behind.colour(g);
            float *sum = &sums_[(g * pixels + pixel) * 4];
            store4(sum, light_.with(load4(sum), g, covered));
        }
        if (Light::sides > 1) light_.put_in_front(pixel, in_front_[cell] - (behind.side > 0 ? hidden : 0));
    }
}

template <typename Light>
void Accumulator<Light>::uncover() {
    const std::size_t layers = Light::sides * scene_.colours.groups;
    for (const std::uint32_t cell : covered_) {
        left_[cell] = 1;
        if (Light::sides > 1) in_front_[cell] = 0;
        for (std::size_t n = 0; n < layers; ++n) store4(&over_[(n * count + cell) * 4], Float4{});
    }
    covered_ = {};
}

template <typename Light>
TilePicture Accumulator<Light>::picture() {
    const std::vector<float> known = light_.known(scene_.colours.groups);
    for (std::size_t n = 0; n < known.size(); ++n) {
        sums_[n] = known[n] > 0 ? sums_[n] / known[n] : 0;
        known_[n / 4] = std::max(known_[n / 4], known[n]);
    }
    return {sums_.data(), known_.data(), scene_.colours.groups, pixels * 4};
}

// Backgrounds lie behind focus, wherever they are seen.
template <typename Light>
std::size_t Accumulator<Light>::side_of(std::uint64_t key) const {
    return Light::sides > 1 && !is_background(key) && scene_.samples.coc[std::uint32_t(key)] < 0 ? 1 : 0;
}

template <typename Light>
typename Accumulator<Light>::Opaque Accumulator<Light>::opaque_at(const Visibility &seen,
                                                                  std::size_t cell) const {
    const auto of = [](const SampleColours &colours, std::uint64_t key, std::size_t side) {
        return Opaque{colours.values.data() + std::size_t(std::uint32_t(key)) * 4, colours.count * 4, side};
    };
    if (const std::uint64_t key = seen.shown()[cell]) return of(scene_.colours, key, side_of(key));
    const std::uint64_t key = seen.filler[cell];
    if (key == 0) return {};
    const bool in_front = Light::sides > 1 && scene_.fillers.samples.coc[std::uint32_t(key)] < 0;
    return of(scene_.fillers.colours, key, in_front);
}

template <typename Light>
float Accumulator<Light>::passes(const Visibility &seen, std::size_t cell, float depth) const {
    const int x = column(cell), y = row(cell);
    return in_tile(x, y) ? held_out_.passes(seen.origin + Imath::V2i(x, y), depth) : 1;
}

template <typename Light>
float Accumulator<Light>::opaque_passes(const Visibility &seen, std::size_t cell) const {
    if (!held_out_.by) return 1;
    const std::uint64_t front = seen.front[cell];
    return passes(seen, cell,
                  front != 0 ? scene_.samples.depth(std::uint32_t(front))
                             : scene_.fillers.samples.depth(std::uint32_t(seen.filler[cell])));
}

template class Accumulator<UniformWeights>;
template class Accumulator<ChannelWeights<1>>;
template class Accumulator<ChannelWeights<2>>;

namespace {

void add(double *to, Float4 values) {
    for (std::size_t k = 0; k < 4; ++k) to[k] += double(values[k]);
}

} // namespace

std::vector<float> UniformWeights::known(std::size_t groups) const {
    std::vector<float> known;
    known.reserve(groups * pixels * 4);
    for (std::size_t g = 0; g < groups; ++g)
        for (const float unknown : unknown_)
            known.insert(known.end(), 4, kernels::known_weight(total_ - unknown, total_));
    return known;
}

template <std::size_t sides_>
ChannelWeights<sides_>::ChannelWeights(const GatherScene &scene)
    : scene_(scene), steps_(scene.colours.groups * size * (size + 1) * 4),
      lost_(scene.colours.groups * pixels * 4), in_front_(sides > 1 ? lost_.size() : 0) {
    for (auto *of : {&light_, &weight_})
        for (auto &channels : *of) channels.resize(scene.colours.groups * 4);
}

template <std::size_t sides_>
void ChannelWeights<sides_>::count(const LensSample &point, const Visibility &seen) {
    total_ += point.weight;
    weigh_channels(point);
    double *row = steps_.data();
    for (std::size_t g = 0; g < scene_.colours.groups; ++g) {
        const Float4 weight = load4(&weight_[0][g * 4]);
        for (const CatEye::Columns &columns : seen.columns) {
            if (columns.begin < columns.end) {
                add(row + columns.begin * 4, weight);
                add(row + columns.end * 4, -weight);
            }
            row += (size + 1) * 4;
        }
    }
}

template <std::size_t sides_>
void ChannelWeights<sides_>::weigh_channels(const LensSample &point) {
    for (std::size_t k = 0; k < light_[0].size(); ++k) {
        const ColourSet set = scene_.colours.sets[k];
        const bool darkened = kernels::is_darkened(set, scene_.cat_eye() && scene_.cat_eye()->darkens());
        for (const std::size_t side : {0u, 1u}) {
            const ColourFactors &rgb = point.rgb, &of_side = side == 1 ? point.in_front : point.behind;
            light_[side][k] = kernels::light_weight(
                set, point.weight, kernels::of_colour(set, rgb[0], rgb[1], rgb[2], 1),
                kernels::of_colour(set, of_side[0], of_side[1], of_side[2], of_side[1]));
            weight_[side][k] = darkened ? point.weight : light_[side][k];
        }
    }
}

template <std::size_t sides_>
void ChannelWeights<sides_>::lose(std::size_t pixel, float share) {
    for (std::size_t g = 0; g < scene_.colours.groups; ++g)
        add(&lost_[(g * pixels + pixel) * 4], share * load4(&weight_[0][g * 4]));
}

template <std::size_t sides_>
void ChannelWeights<sides_>::put_in_front(std::size_t pixel, float share) {
    if constexpr (sides > 1)
        for (std::size_t g = 0; g < scene_.colours.groups; ++g) {
            float *more = &in_front_[(g * pixels + pixel) * 4];
            store4(more, load4(more) + share * (load4(&weight_[1][g * 4]) - load4(&weight_[0][g * 4])));
        }
}

template <std::size_t sides_>
std::vector<float> ChannelWeights<sides_>::known(std::size_t groups) const {
    std::vector<float> known(groups * pixels * 4);
    const double *step = steps_.data();
    for (std::size_t row = 0, at = 0; row < groups * size; ++row, step += 4) {
        std::array<double, 4> sum{};
        for (std::size_t n = 0; n < size * 4; ++n, ++at)
            known[at] = kernels::known_weight(
                float((sum[n % 4] += *step++) - lost_[at] + (sides > 1 ? double(in_front_[at]) : 0)), total_);
    }
    return known;
}

template class ChannelWeights<1>;
template class ChannelWeights<2>;

} // namespace sparselens
