#include "ldi/misplaced_view.h"

#include "view/view_mapping.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sparselens {

namespace {

constexpr double samples_a_side = 160; // of the view's pixels, enough to tell
constexpr double same_surface = 1;     // pixels of parallax
constexpr double clearly = 0.7;        // times the disagreement
constexpr double at_least = 0.02;      // less: rounding, noise

double relative_difference(const View &centre, const View &view, const Imath::V2i &p, const Imath::V2i &q) {
    double off = 0, light = 1e-6; // both dark: no difference
    for (const char *name : {"R", "G", "B"}) {
        const std::size_t c = find_channel(centre.image.channels, name),
                          v = find_channel(view.image.channels, name);
        if (c == npos || v == npos) continue;
        const double a = double(centre.image.at(c, p.x, p.y)), b = double(view.image.at(v, q.x, q.y));
        off += std::abs(a - b);
        light += std::abs(a) + std::abs(b);
    }
    return off / light;
}

float depth_at(const View &view, const Imath::V2i &p) {
    const Windows &w = view.image.windows;
    return view.z[std::size_t(p.y - w.data.min.y) * std::size_t(w.width()) + std::size_t(p.x - w.data.min.x)];
}

bool shows_something(const View &view, const Imath::V2i &p) {
    const std::size_t alpha = find_channel(view.image.channels, "A");
    return depth_at(view, p) > 0 && (alpha == npos || view.image.at(alpha, p.x, p.y) > 0);
}

// visit(q, landed) for a grid of the view's pixels: where the centre view shows what they show.
template <typename Visit>
void for_each_sampled(const View &view, const ViewMapping &mapping, const Visit &visit) {
    const Windows &w = view.image.windows;
    const int step_x = int(std::ceil(w.width() / samples_a_side)),
              step_y = int(std::ceil(w.height() / samples_a_side));
    for (int y = w.data.min.y; y <= w.data.max.y; y += step_y)
        for (int x = w.data.min.x; x <= w.data.max.x; x += step_x) {
            const Imath::V2i q(x, y);
            if (!shows_something(view, q)) continue;
            const Imath::V2d place = Imath::V2d(q) + Imath::V2d(0.5);
            visit(q, mapping.at_infinity(place) + mapping.parallax(place) / double(depth_at(view, q)));
        }
}

ViewMapping mapping_from(const View &centre, const View &view, const Imath::V2d &position, double focal_px) {
    return {position, focal_px, view.image.windows, view.framing, centre.framing.principal_point};
}

double largest_parallax(const View &view, const ViewMapping &mapping) {
    double largest = 0;
    for_each_sampled(view, mapping, [&](const Imath::V2i &q, const Imath::V2d &landed) {
        const Imath::V2d far = mapping.at_infinity(Imath::V2d(q) + Imath::V2d(0.5));
        largest = std::max(largest, (landed - far).length());
    });
    return largest;
}

} // namespace

double disagreement(const View &centre, const View &view, const Imath::V2d &position, double focal_px) {
    const Imath::Box2i &inside = centre.image.windows.data;
    const double scale = focal_px * view.position.length(); // of parallax, the same wherever the view is put
    double sum = 0;
    std::size_t compared = 0;
    const ViewMapping mapping = mapping_from(centre, view, position, focal_px);
    for_each_sampled(view, mapping, [&](const Imath::V2i &q, const Imath::V2d &landed) {
        if (!(landed.x >= inside.min.x && landed.x < inside.max.x + 1.0 && landed.y >= inside.min.y &&
              landed.y < inside.max.y + 1.0))
            return;
        const Imath::V2i p(int(std::floor(landed.x)), int(std::floor(landed.y)));
        const double in_front = scale / double(depth_at(view, q)) - scale / double(depth_at(centre, p));
        const bool nothing = !shows_something(centre, p);
        ++compared;
        if (!nothing && in_front < -same_surface) return; // hidden from the centre, as it may be
        sum += nothing || in_front > same_surface ? 1 : relative_difference(centre, view, p, q);
    });
    return compared > 0 ? sum / double(compared) : 0;
}

std::optional<Imath::V2d> better_position(const View &centre, const View &view, double focal_px) {
    const Imath::V2d &at = view.position;
    const bool elsewhere_shows = largest_parallax(view, mapping_from(centre, view, at, focal_px)) >= 1;
    if (!elsewhere_shows) return {}; // wherever it stands within that, it shows the same
    const std::array<Imath::V2d, 6> others{
        {{-at.x, -at.y}, {-at.x, at.y}, {at.x, -at.y}, {at.y, at.x}, {-at.y, -at.x}, {0, 0}}};
    const double stated = disagreement(centre, view, at, focal_px);
    double least = std::min(clearly * stated, stated - at_least);
    std::optional<Imath::V2d> better;
    for (const Imath::V2d &other : others) {
        const double there = disagreement(centre, view, other, focal_px);
        if (there >= least) continue;
        least = there;
        better = other;
    }
    return better;
}

} // namespace sparselens
