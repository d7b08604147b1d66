#include "dof/highlight_gain.h"

#include "base/luminance.h"
#include "base/parallel.h"

#include <algorithm>

namespace sparselens {

double highlight_factor(const HighlightGain &by, double luminance) {
    const double t = std::clamp((luminance - by.threshold) / by.knee, 0.0, 1.0);
    return 1 + (by.gain - 1) * t * t * (3 - 2 * t);
}

void raise_highlights(Ldi &ldi, const HighlightGain &by) {
    const auto rgb = find_rgb(ldi.channels);
    if (by.gain == 1 || !all_found(rgb)) return;
    const std::size_t alpha = ldi.alpha();
    parallel_ranges(ldi.samples(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const double coverage = alpha == npos ? 1 : double(ldi.values[alpha][i]);
            double luminance = 0;
            for (std::size_t c = 0; c < 3; ++c) luminance += luma_weights[c] * double(ldi.values[rgb[c]][i]);
            // Light without coverage, as of a glow, is taken as it is.
            const double factor = highlight_factor(by, coverage > 0 ? luminance / coverage : luminance);
            for (const std::size_t k : rgb) ldi.values[k][i] = float(double(ldi.values[k][i]) * factor);
        }
    });
}

} // namespace sparselens
