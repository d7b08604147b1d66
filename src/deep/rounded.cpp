#include "deep/rounded.h"

#include "base/channel_kind.h"
#include "base/parallel.h"
#include "deep/channel_alpha.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

namespace sparselens {

namespace {

constexpr float finest_px = 1.0f / 64; // the largest change of a depth or an offset, and the step of offsets
constexpr int fraction_bits = std::numeric_limits<float>::digits - 1;
constexpr int colour_bits = 8, weight_bits = 4; // kept bits of the fraction: off by half of the last at most

// Rounds to this number of bits of the fraction, to even. It keeps the order of numbers.
float rounded(float value, int bits) {
    const int dropped = fraction_bits - bits;
    if (dropped <= 0 || !std::isfinite(value)) return value;
    const auto pattern = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t last = pattern >> dropped & 1, half = (std::uint32_t{1} << (dropped - 1)) - 1;
    const auto made = std::bit_cast<float>((pattern + half + last) & ~((std::uint32_t{1} << dropped) - 1));
    return std::isfinite(made) ? made : value;
}

// Keeps as many bits of the fraction as hold the depth within finest_px. Their number depends on its exponent alone, so
// rounding keeps the order of two depths.
float rounded_depth(float z, double scale) {
    if (!std::isfinite(z) || z == 0) return z;
    const int exponent = std::ilogb(z);
    const double most =
        std::abs(scale) / std::ldexp(1.0, exponent); // the largest perceptive depth with this exponent
    // The relative error is at most 2^-(bits + 1), for the depth and so for its perceptive depth.
    const double bits = std::ceil(std::log2(most / double(finest_px))) - 1;
    return rounded(z, int(std::clamp(bits, 0.0, double(fraction_bits))));
}

// Leaves a pixel alone if two different depths of it would become equal, because it would no longer be tidy.
void round_depths(Ldi &ldi, std::size_t pixel, double scale, std::vector<float> &depths) {
    depths.clear();
    for (const std::uint64_t i : ldi.pixel(pixel)) {
        depths.push_back(ldi.z[i]);
        if (!ldi.z_back.empty()) depths.push_back(ldi.z_back[i]);
    }
    std::ranges::sort(depths);
    for (std::size_t n = 1; n < depths.size(); ++n)
        if (depths[n - 1] != depths[n] &&
            rounded_depth(depths[n - 1], scale) == rounded_depth(depths[n], scale))
            return;
    for (const std::uint64_t i : ldi.pixel(pixel)) {
        ldi.z[i] = rounded_depth(ldi.z[i], scale);
        if (!ldi.z_back.empty()) ldi.z_back[i] = rounded_depth(ldi.z_back[i], scale);
    }
}

template <typename Round>
void for_each_value(std::vector<float> &values, const Round &round) {
    constexpr std::size_t at_once = 1 << 16;
    parallel_ranges(values.size(), at_once, [&](std::size_t begin, std::size_t end) {
        for (float &value : std::span(values).subspan(begin, end - begin)) value = round(value);
    });
}

bool is_colour(std::span<const Channel> channels, std::size_t k) {
    return is_light(channels[k]) && coverage_of(channels, k) != k;
}

} // namespace

void round_for_lens(Ldi &ldi, double scale) {
    if (scale > 0) {
        for_each_value(ldi.optical, [&](float z) { return rounded_depth(z, scale); });
        parallel_ranges(ldi.windows.pixels(), 4096, [&](std::size_t begin, std::size_t end) {
            std::vector<float> depths;
            for (std::size_t pixel = begin; pixel < end; ++pixel) round_depths(ldi, pixel, scale, depths);
        });
    }
    for (auto *offsets : {&ldi.dx, &ldi.dy})
        for_each_value(*offsets, [](float v) { return std::nearbyint(v / finest_px) * finest_px; });
    for (auto *shares : {&ldi.weight, &ldi.solid})
        for_each_value(*shares, [](float v) { return rounded(v, weight_bits); });
    for (std::size_t k = 0; k < ldi.channels.size(); ++k)
        if (is_colour(ldi.channels, k))
            for_each_value(ldi.values[k], [](float v) { return rounded(v, colour_bits); });
}

} // namespace sparselens
