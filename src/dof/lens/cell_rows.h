// Tests several cells of a tile (see.h) at once: which of them are empty, and where a crack may lie. The results are
// the same on every processor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace sparselens {

// Returns a bit for each of 64 keys: whether it is 0.
std::uint64_t zeros_of(const std::uint64_t *keys);

// Writes the perceptive depth, in pixels, of each key (kernels/lens_rules.h).
void depths_of(std::span<const std::uint64_t> keys, float *depths);

// Returns a bit for each of 64 cells: whether it shows something farther than the cells on two opposite sides of it, so
// that a crack may lie there. `stride`: from one row to the next. The cells around the 64 are read as well.
std::uint64_t far_behind(const float *depths, std::ptrdiff_t stride);

} // namespace sparselens
