#include "base/plane.h"

#include <algorithm>
#include <bit>

namespace sparselens {

namespace {

// Sets halves of 0 and of what is normal among halves, whose bits only move. False: there is something else.
bool move_bits(std::span<const float> values, std::uint16_t *halves) {
    constexpr std::uint32_t sign = 0x80000000, least = 0x38800000, end = 0x47800000, lost = 0x1fff,
                            exponents = 0x38000000; // 2^-14, 2^16; what a half has no place for
    std::uint32_t others = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto bits = std::bit_cast<std::uint32_t>(values[i]), magnitude = bits & ~sign;
        const bool normal = magnitude - least < end - least;
        const std::uint32_t moved = normal ? (magnitude - exponents) >> 13 : 0;
        others |= (normal ? magnitude & lost : magnitude);
        halves[i] = static_cast<std::uint16_t>((bits & sign) >> 16 | moved);
    }
    return others == 0;
}

bool as_halves(std::span<const float> values, std::uint16_t *halves) {
    if (move_bits(values, halves)) return true;
    std::ranges::transform(values, halves, bits_of_half);
    return std::ranges::all_of(values, is_half);
}

// As of_half(), many at once: its table does not stay in the cache.
void from_halves(std::span<const std::uint16_t> halves, std::span<float> out) {
    constexpr std::uint32_t not_finite = 0x7c00, exponents = 0x7f800000;
    for (std::size_t i = 0; i < halves.size(); ++i) {
        const std::uint32_t magnitude = halves[i] & 0x7fffu, sign = std::uint32_t(halves[i] & 0x8000u) << 16;
        const std::uint32_t finite =
            std::bit_cast<std::uint32_t>(std::bit_cast<float>(magnitude << 13) * 0x1p112f);
        out[i] = std::bit_cast<float>((magnitude < not_finite ? finite : magnitude << 13 | exponents) | sign);
    }
}

} // namespace

Plane Plane::packed(std::span<const float> values) {
    Plane plane;
    const auto bits = [](float v) { return std::bit_cast<std::uint32_t>(v); };
    const bool same =
        !values.empty() && std::ranges::all_of(values, [&](float v) { return bits(v) == bits(values[0]); });
    if (same) {
        plane.own_ = {values[0]};
        plane.mask_ = 0;
        plane.floats_ = plane.own_.data();
        return plane;
    }
    constexpr std::size_t at_once = 4096;
    plane.halves_.resize(values.size());
    bool fit = true;
    for (std::size_t i = 0; i < values.size() && fit; i += at_once)
        fit = as_halves(values.subspan(i, std::min(at_once, values.size() - i)), &plane.halves_[i]);
    if (fit) return plane;
    std::vector<std::uint16_t>().swap(plane.halves_);
    plane.own_.assign(values.begin(), values.end());
    plane.floats_ = plane.own_.data();
    return plane;
}

void Plane::copy(std::size_t first, std::span<float> out) const {
    if (!floats_)
        from_halves(std::span(halves_).subspan(first, out.size()), out);
    else if (mask_ == 0)
        std::ranges::fill(out, floats_[0]);
    else
        std::copy_n(floats_ + first, out.size(), out.begin());
}

Plane Plane::of(std::span<const float> values) {
    Plane plane;
    plane.floats_ = values.data();
    return plane;
}

} // namespace sparselens
