#include "dof/facets/links.h"

#include "dof/facets/facets.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

LinkedSample Links::nearest(const Imath::V2i &pixel, float depth) const {
    LinkedSample found;
    for_each_opaque(pixel, [&](const LinkedSample &s) {
        if (!found.found() || std::abs(s.depth - depth) < std::abs(found.depth - depth)) found = s;
    });
    return found;
}

// Returns the sizes of the next two steps of depth along the surface, as long as they have the sign of `expected`; else
// 0.
Links::Steps Links::steps_beyond(const LinkedSample &from, const Imath::V2i &pixel, const Imath::V2i &step,
                                 float expected) const {
    Steps steps{0, 0};
    LinkedSample last = from;
    for (std::size_t n = 0; n < steps.size(); ++n) {
        const LinkedSample next = nearest(pixel + int(n + 1) * step, last.depth + expected);
        if (!next.found() || (next.depth - last.depth) * expected <= 0) break;
        expected = next.depth - last.depth;
        steps[n] = std::abs(expected);
        last = next;
    }
    return steps;
}

LinkedSample Links::linked(const LinkedSample &a, const Imath::V2i &pixel, const Imath::V2i &step) const {
    if (!a.found()) return a;
    const LinkedSample b = nearest(pixel + step, a.depth);
    if (!b.found()) return b;
    if (kernels::is_one_surface(a.depth, b.depth, steep_px)) return b;
    const float difference = b.depth - a.depth;
    const Steps on = steps_beyond(b, pixel + step, step, difference);
    const Steps back = steps_beyond(a, pixel, Imath::V2i(0) - step, 0 - difference);
    const float slope =
        std::max({std::min(on[0], on[1]), std::min(back[0], back[1]), std::min(on[0], back[0])});
    return std::abs(difference) - steep_px < 2 * slope ? b : LinkedSample{};
}

} // namespace sparselens
