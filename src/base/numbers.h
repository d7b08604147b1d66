// Small functions of numbers.
#pragma once

#include <Imath/ImathVec.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <ranges>

namespace sparselens {

// Deterministic numbers for sampling: hashes and a low-discrepancy sequence, without state and without a seed.

// A 32-bit hash whose every output bit depends on every input bit (the finalizer of MurmurHash3, A. Appleby).
constexpr std::uint32_t mix_bits(std::uint32_t h) {
    h ^= h >> 16;
    h *= 0x85ebca6bu;
    h ^= h >> 13;
    h *= 0xc2b2ae35u;
    h ^= h >> 16;
    return h;
}

constexpr std::uint32_t mix_bits(std::uint32_t a, std::uint32_t b) { return mix_bits(a ^ mix_bits(b)); }

// A number in [0, 1), exact in float and in double.
constexpr double unit_interval(std::uint32_t h) { return double(h >> 8) * 0x1p-24; }

// Point `index` of the two-dimensional Kronecker sequence with the plastic number (M. Roberts, "The
// unreasonable effectiveness of quasirandom sequences", 2018), shifted modulo 1; `shift` and the point are in [0, 1).
inline Imath::V2d low_discrepancy_2d(std::uint32_t index, const Imath::V2d &shift) {
    // 1/g and 1/g^2 in units of 2^-32, so that the fractional part is the integer product's wrap-around.
    const std::uint32_t x = index * 3242174889u, y = index * 2447445414u;
    Imath::V2d p(double(x) * 0x1p-32 + shift.x, double(y) * 0x1p-32 + shift.y);
    if (p.x >= 1) p.x -= 1;
    if (p.y >= 1) p.y -= 1;
    return p;
}

// a / b, rounded down, also below 0; b > 0.
constexpr int floor_div(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

// The median of at least one value; for an even number, the upper one of the two in the middle. Reorders them.
template <std::ranges::random_access_range Values>
auto median(Values &&values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// Four channels in one register. They are loaded and stored unchanged, and calculated like single floats.
using Float4 [[gnu::vector_size(16)]] = float;

inline Float4 load4(const float *from) {
    Float4 value;
    std::memcpy(&value, from, sizeof(value));
    return value;
}
inline void store4(float *to, Float4 value) { std::memcpy(to, &value, sizeof(value)); }

} // namespace sparselens
