#include "base/plane.h"

#include "base/float4.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace sparselens {

namespace {

// Sets the halves if every value is 0 or a normal half, because then the bits only move. Returns false if there is any
// other value.
bool move_bits(std::span<const float> values, std::uint16_t *halves) {
    constexpr std::uint32_t sign = 0x80000000, least = 0x38800000, end = 0x47800000, lost = 0x1fff,
                            exponents = 0x38000000; // 2^-14, 2^16; bits that a half cannot hold
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

using Half4 [[gnu::vector_size(8)]] = std::uint16_t;
using Bits4 [[gnu::vector_size(16)]] = std::uint32_t;

// Converts like of_half().
template <typename Bits, typename Float>
Bits float_bits(Bits half) {
    const Bits magnitude = half & 0x7fffu, sign = (half & 0x8000u) << 16, moved = magnitude << 13;
    const Bits finite = std::bit_cast<Bits>(std::bit_cast<Float>(moved) * 0x1p112f);
    return (magnitude < 0x7c00u ? finite : moved | 0x7f800000u) | sign;
}

// Converts many at once, because the table of of_half() does not stay in the cache.
void from_halves(std::span<const std::uint16_t> halves, std::span<float> out) {
    std::size_t i = 0;
    for (; i + 4 <= halves.size(); i += 4) {
        Half4 four;
        std::memcpy(&four, &halves[i], sizeof(four));
        store4(&out[i],
               std::bit_cast<Float4>(float_bits<Bits4, Float4>(__builtin_convertvector(four, Bits4))));
    }
    for (; i < halves.size(); ++i) out[i] = std::bit_cast<float>(float_bits<std::uint32_t, float>(halves[i]));
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
