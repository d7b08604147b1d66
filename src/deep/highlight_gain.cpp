#include "deep/highlight_gain.h"

#include "base/luminance.h"
#include "base/parallel.h"

#include <algorithm>

namespace sparselens {

HighlightGain highlight_gain(const LookValues &values) {
    const HighlightGain none;
    return {values.highlight_gain.value_or(none.gain), values.highlight_threshold.value_or(none.threshold),
            values.highlight_knee.value_or(none.knee)};
}

double highlight_factor(const HighlightGain &by, double luminance) {
    const double t = std::clamp((luminance - by.threshold) / by.knee, 0.0, 1.0);
    return 1 + (by.gain - 1) * t * t * (3 - 2 * t);
}

double highlight_factor(const HighlightGain &by, const std::array<double, 3> &rgb, double coverage) {
    double luminance = 0;
    for (std::size_t c = 0; c < 3; ++c) luminance += luma_weights[c] * rgb[c];
    return highlight_factor(by, coverage > 0 ? luminance / coverage : luminance);
}

void raise_highlights(Ldi &ldi, const HighlightGain &by) {
    const auto rgb = find_rgb(ldi.channels);
    if (by.gain == 1 || !all_found(rgb)) return;
    const std::size_t alpha = ldi.alpha();
    parallel_ranges(ldi.samples(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const double coverage = alpha == npos ? 1 : double(ldi.values[alpha][i]);
            const double factor = highlight_factor(
                by,
                {double(ldi.values[rgb[0]][i]), double(ldi.values[rgb[1]][i]), double(ldi.values[rgb[2]][i])},
                coverage);
            for (const std::size_t k : rgb) ldi.values[k][i] = float(double(ldi.values[k][i]) * factor);
        }
    });
}

} // namespace sparselens
