// Halves (16 bits) of floats, bit by bit.
#pragma once

#include <half.h>

#include <bit>
#include <cstdint>

namespace sparselens {

inline std::uint16_t bits_of_half(float value) { return Imath::half(value).bits(); } // rounded

inline float of_half(std::uint16_t bits) { return float(Imath::half(Imath::half::FromBits, bits)); }

// Whether a half holds every bit of the value.
inline bool is_half(float value) {
    return std::bit_cast<std::uint32_t>(of_half(bits_of_half(value))) == std::bit_cast<std::uint32_t>(value);
}

} // namespace sparselens
