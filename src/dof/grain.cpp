#include "dof/grain.h"

#include "base/light.h"
#include "base/numbers.h"
#include "base/parallel.h"
#include "dof/tuning.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

namespace sparselens {

namespace {

constexpr int side = 16; // of a block, pixels

struct Block {
    float brightness, variance;
};

// The mean of some channels in the block of pixels from `from` on; nothing if a pixel of it, or beside it, is missing.
std::optional<Block> measured(const Ldi &ldi, std::span<const std::size_t> channels, const Imath::V2i &from) {
    constexpr int wide = side + 2;
    std::array<double, wide * wide> values{};
    for (int i = 0; i < wide * wide; ++i) {
        const Imath::V2i at = from + Imath::V2i(i % wide - 1, i / wide - 1);
        if (!ldi.windows.data.intersects(at)) return {};
        const SampleRange samples = ldi.pixel(ldi.windows.index(at));
        if (samples.empty()) return {};
        for (const std::size_t k : channels)
            values[std::size_t(i)] += double(ldi.values[k][samples.front()]) / double(channels.size());
    }
    double sum = 0, squares = 0;
    for (int i = 0; i < side * side; ++i) {
        const double *const v = &values[std::size_t(i / side * wide + i % side)];
        const auto row = [v](int y) { return v[y * wide] - 2 * v[y * wide + 1] + v[y * wide + 2]; };
        const double detail = row(0) - 2 * row(1) + row(2);
        sum += v[wide + 1], squares += detail * detail;
    }
    return Block{float(sum / (side * side)), float(squares / (36 * side * side))};
}

// The height of one of the `steps` that sRGB has from 0 to 1, in linear light.
float step_of(float brightness, float steps) {
    const double shown = srgb_encoded(double(brightness)), half = 0.5 / double(steps);
    return float(srgb_decoded(shown + half) - srgb_decoded(shown - half));
}

float variance_of_rounding(float brightness, int bits) {
    if (bits == 0) return 0;
    const float step = step_of(brightness, std::exp2(float(bits)) - 1);
    return step * step / 12;
}

// In steps that a display of 8 bits can show.
float shown_variance(const Grain::Group &group) {
    const float shown = group.deviation / step_of(group.brightness, 255);
    return shown * shown;
}

// Nearly normal, variance 1: the sum of four bytes.
float normal(std::uint32_t bits) {
    const std::uint32_t sum = (bits & 255) + (bits >> 8 & 255) + (bits >> 16 & 255) + (bits >> 24);
    return (float(sum) - 510) / std::sqrt(65535 / 3.0f);
}

} // namespace

float Grain::deviation(std::size_t channel, float brightness) const {
    const std::vector<Group> &of = groups[channel];
    const auto after = std::ranges::lower_bound(of, brightness, {}, &Group::brightness);
    if (after == of.begin()) return after->deviation;
    const Group &before = *(after - 1);
    if (after == of.end()) return before.deviation;
    return std::lerp(before.deviation, after->deviation,
                     (brightness - before.brightness) / (after->brightness - before.brightness));
}

namespace {

std::vector<Grain::Group> groups_of(const Ldi &ldi, std::span<const std::size_t> channels, int bits) {
    const Imath::V2i origin = ldi.windows.display.min; // a moved picture has the same blocks
    const Imath::V2i least = ldi.windows.data.min - origin, most = ldi.windows.data.max - origin;
    const int first = floor_div(least.y, side), rows = floor_div(most.y, side) - first + 1;
    std::vector<Block> blocks = joined(std::size_t(rows), [&](std::size_t row) {
        std::vector<Block> found;
        for (int x = floor_div(least.x, side); x <= floor_div(most.x, side); ++x)
            if (const auto block = measured(ldi, channels, origin + Imath::V2i(x, first + int(row)) * side))
                found.push_back(*block);
        return found;
    });
    std::ranges::stable_sort(blocks, {}, &Block::brightness);
    const std::size_t count = std::clamp<std::size_t>(blocks.size() / GatherTuning::grain_group_least, 1,
                                                      GatherTuning::grain_groups);
    std::vector<Grain::Group> groups;
    for (std::size_t i = 0; i < count && !blocks.empty(); ++i) {
        const std::span<Block> some =
            std::span(blocks).subspan(blocks.size() * i / count, blocks.size() / count);
        const float brightness = some[some.size() / 2].brightness;
        std::ranges::sort(some, {}, &Block::variance);
        const float low = some[std::size_t(GatherTuning::grain_quantile * double(some.size()))].variance;
        groups.push_back({brightness, std::sqrt(std::max(0.0f, low / GatherTuning::grain_of_quantile -
                                                                   variance_of_rounding(brightness, bits)))});
    }
    for (std::size_t i = 1; i + 1 < groups.size(); ++i) // one may be all texture
        groups[i].deviation =
            std::min(groups[i].deviation, std::max(groups[i - 1].deviation, groups[i + 1].deviation));
    return groups;
}

} // namespace

Grain measure_grain(const Ldi &photograph, int bits) {
    const std::array rgb = find_rgb(photograph.channels);
    if (!all_found(rgb)) return {};
    Grain grain;
    const auto add = [](double sum, const Grain::Group &group) {
        return sum + double(group.deviation * group.deviation);
    };
    double variances = 0, shown = 0;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        grain.groups[k] = groups_of(photograph, {&rgb[k], 1}, bits);
        variances = std::accumulate(grain.groups[k].begin(), grain.groups[k].end(), variances, add);
        for (const Grain::Group &group : grain.groups[k]) shown += double(shown_variance(group)), ++count;
    }
    if (shown <= GatherTuning::grain_shown * double(count)) return {};
    const auto of_mean = groups_of(photograph, rgb, 0); // has (1 + 2 correlation) / 3 of the mean variance
    const double variance = std::accumulate(of_mean.begin(), of_mean.end(), 0.0, add);
    grain.correlation = float(std::clamp(4.5 * variance / variances - 0.5, 0.0, 1.0));
    return grain;
}

void add_kept_share(Ldi &photograph, const ThinLens &lens) {
    const std::size_t alpha = photograph.alpha();
    std::vector<float> kept(photograph.samples());
    parallel_ranges(kept.size(), 1 << 16, [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i) {
            const double r = std::abs(circle_of_confusion(lens, photograph.coc_z(i)));
            const double share = 1 / (1 + GatherTuning::grain_rim * r + std::numbers::pi * r * r);
            kept[i] = float(share) * (alpha == npos ? 1 : photograph.values[alpha][i]);
        }
    });
    photograph.channels.push_back({"grain.kept", PixelType::float32, ChannelKind::data});
    photograph.values.push_back(std::move(kept));
}

void add_grain(const Grain &grain, float strength, std::uint32_t frame, const LensTiles &tiles,
               const Imath::Box2i &gathered, Image &picture) {
    const Grid pixels = picture.windows.grid();
    const std::array rgb = find_rgb(picture.channels);
    const std::size_t alpha = find_channel(picture.channels, "A"), kept = picture.channels.size() - 1;
    const float shared = std::sqrt(grain.correlation), own = std::sqrt(1 - grain.correlation);
    parallel_for(tiles.lens_points.empty() ? 0 : std::size_t(pixels.height()), [&](std::size_t row) {
        for (std::size_t i = row * std::size_t(pixels.width()), n = 0; n < std::size_t(pixels.width());
             ++i, ++n) {
            const Imath::V2i at = pixels.pixel(i), tile = (at - gathered.min) / tiles.size;
            if (tiles.lens_points[std::size_t(tile.y * tiles.columns + tile.x)] == 0) continue;
            const float lost = (alpha == npos ? 1 : picture.plane(alpha)[i]) - picture.plane(kept)[i];
            if (!(lost > 0)) continue;
            const Imath::V2i place = at - picture.windows.display.min;
            const std::uint32_t seed =
                mix_bits(std::uint32_t(place.x), mix_bits(std::uint32_t(place.y), frame));
            for (std::size_t k = 0; k < 3; ++k) {
                float &value = picture.plane(rgb[k])[i];
                const float noise =
                    shared * normal(seed) + own * normal(mix_bits(seed, std::uint32_t(k + 1)));
                value = std::max(value + strength * std::sqrt(lost) * grain.deviation(k, value) * noise,
                                 std::min(value, 0.0f)); // noise makes no light negative
            }
        }
    });
    picture.channels.pop_back();
    picture.values.resize(picture.channels.size() * picture.windows.pixels());
}

} // namespace sparselens
