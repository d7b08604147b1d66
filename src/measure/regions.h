// The three regions of a picture for which errors are reported separately: docs/design.md section 6.
//
// Each is a set of pixels, given by the signed CoC radius c (pixels) of each pixel's front sample
// (deep/flatten.h):
//   in_focus     |c| < 1
//   blurred      |c| > 8
//   silhouettes  within the local |c| of a jump of c larger than 1 between two of the four neighbours, where the local
//                |c| is the larger of the two at the jump, and at least 1. Distances are measured from the centres of
//                the two pixels, in y stretched by the pixel aspect like the CoC itself.
// A pixel may belong to several regions or to none.
#pragma once

#include "../base/image.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

inline constexpr std::array<const char *, 3> region_names{"in_focus", "blurred", "silhouettes"};
enum RegionBit : std::uint8_t { in_focus_bit = 1, blurred_bit = 2, silhouettes_bit = 4 };

// The RegionBits of each pixel; `c` holds width * height values, row by row. The run time does not depend on the
// values of c.
std::vector<std::uint8_t> region_bits(std::span<const float> c, int width, int height,
                                      double pixel_aspect = 1);

// The bits over another data window; the corners of the display windows coincide. Pixels outside `from` belong to no
// region.
std::vector<std::uint8_t> bits_over(std::span<const std::uint8_t> bits, const Windows &from,
                                    const Windows &target);

} // namespace sparselens
