#include "lens/sharp_range.h"

#include "lens/perceptive_depth.h"

#include <cmath>
#include <limits>

namespace sparselens {

SharpRange sharp_range(const ThinLens &lens, double sharp) {
    const double scale = perceptive_scale(lens.radius, lens.focal_px), hyperfocal = scale / sharp;
    if (std::isinf(lens.focus)) return {hyperfocal, lens.focus, hyperfocal};
    const double near = hyperfocal > 0 ? lens.focus / (1 + lens.focus / hyperfocal) : 0;
    const double far = lens.focus < hyperfocal ? lens.focus / (1 - lens.focus / hyperfocal)
                                               : std::numeric_limits<double>::infinity();
    return {near, far, hyperfocal};
}

FocusFor focus_for(double near, double far) {
    const double ratio = near / far; // 0 if the range goes on to infinity
    return {2 * near / (1 + ratio), 2 * near / (1 - ratio)};
}

} // namespace sparselens
