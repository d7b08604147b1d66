// Rows of a tile's cells (see.h), looked at several at once: which of them are empty, and behind which a crack may lie. The same
// on every processor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace sparselens {

// Which of 64 keys are 0, bit by bit.
std::uint64_t zeros_of(const std::uint64_t *keys);

// The depths, perceptive and in pixels, of as many keys (kernels/lens_rules.h).
void depths_of(std::span<const std::uint64_t> keys, float *depths);

// Which of 64 cells show what is farther than on either side of them, so that a crack may lie there, bit by bit. `stride`: from one
// row to the next; the cells around the 64 are read as well.
std::uint64_t far_behind(const float *depths, std::ptrdiff_t stride);

} // namespace sparselens
