// The built-in functions of GLSL, for the other headers of this folder. Those are written in the common part of C++ and
// GLSL, and the build turns them into GLSL (cmake/AsGlsl.cmake). Each rule that both the CPU and a device follow is
// there once.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace sparselens::kernels {

using std::abs, std::asin, std::floor, std::max, std::min, std::pow, std::sqrt;
using uint = std::uint32_t;
using uint64_t = std::uint64_t;
static_assert(sizeof(int) == sizeof(uint) && sizeof(float) == 4 && sizeof(double) == 8);

inline uint floatBitsToUint(float value) { return std::bit_cast<uint>(value); }
inline float uintBitsToFloat(uint bits) { return std::bit_cast<float>(bits); }

} // namespace sparselens::kernels
