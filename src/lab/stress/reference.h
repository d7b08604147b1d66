// The lens picture in long double, from the formulas of design.md section 1 and nothing else of this library's
// kernels: every lens point of every pixel tries every sample. Slow.
#pragma once

#include "deep/ldi.h"
#include "lens/lens_samples.h"
#include "lens/thin_lens.h"

#include <span>
#include <vector>

namespace sparselens::lab::stress {

struct LongPicture {
    // [channel][pixel] of the LDI's data window; flattened where no lens point sees anything.
    std::vector<long double> values;
    // Not where the edge of a sample passes a lens point closer than what float arithmetic can tell: which side it
    // lies on is then a matter of rounding, and the pixel's answer one of several.
    std::vector<bool> sure; // [pixel]
};

LongPicture long_lens_picture(const Ldi &ldi, const ThinLens &lens, std::span<const LensSample> points);

} // namespace sparselens::lab::stress
