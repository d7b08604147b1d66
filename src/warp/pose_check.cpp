#include "warp/pose_check.h"

#include "lens/perceptive_depth.h"
#include "view/view_mapping.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sparselens {

namespace {

constexpr double samples_a_side = 160; // of the view's pixels, enough to tell
constexpr double same_depth = 1;       // pixels of parallax: either view's place is known to a pixel
constexpr double clearly = 0.7;        // times the disagreement
constexpr double at_least = 0.02;      // less: rounding, noise

// The colours that both views have: the index of each in either.
std::vector<std::pair<std::size_t, std::size_t>> common_colours(const View &centre, const View &view) {
    std::vector<std::pair<std::size_t, std::size_t>> common;
    const auto of_centre = find_rgb(centre.image.channels), of_view = find_rgb(view.image.channels);
    for (std::size_t k = 0; k < 3; ++k)
        if (of_centre[k] != npos && of_view[k] != npos) common.emplace_back(of_centre[k], of_view[k]);
    return common;
}

// A view, to be asked pixel by pixel.
class Pixels {
public:
    explicit Pixels(const View &view) : view_(view), alpha_(find_channel(view.image.channels, "A")) {}

    bool show_something(const Imath::V2i &p) const {
        return depth(p) > 0 && (alpha_ == npos || view_.image.at(alpha_, p.x, p.y) > 0);
    }
    double depth(const Imath::V2i &p) const { return view_.z[view_.image.windows.index(p.x, p.y)]; }

private:
    const View &view_;
    std::size_t alpha_;
};

// visit(q, landed) for a grid of the view's pixels: where the centre view shows what they show.
template <typename Visit>
void for_each_sampled(const View &view, const ViewMapping &mapping, const Visit &visit) {
    const Windows &w = view.image.windows;
    const Pixels pixels(view);
    const int step_x = int(std::ceil(w.width() / samples_a_side)),
              step_y = int(std::ceil(w.height() / samples_a_side));
    for (int y = w.data.min.y; y <= w.data.max.y; y += step_y)
        for (int x = w.data.min.x; x <= w.data.max.x; x += step_x) {
            const Imath::V2i q(x, y);
            if (!pixels.show_something(q)) continue;
            const Imath::V2d place = Imath::V2d(q) + Imath::V2d(0.5);
            visit(q, mapping.at_infinity(place) + mapping.parallax(place) * (1 / pixels.depth(q)));
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
    const Pixels in_centre(centre), in_view(view);
    const auto colours = common_colours(centre, view);
    const auto relative_difference = [&](const Imath::V2i &p, const Imath::V2i &q) {
        double off = 0, light = 1e-6; // both dark: no difference
        for (const auto &[c, v] : colours) {
            const double a = centre.image.at(c, p.x, p.y), b = view.image.at(v, q.x, q.y);
            off += std::abs(a - b);
            light += std::abs(a) + std::abs(b);
        }
        return off / light;
    };
    double sum = 0;
    std::size_t compared = 0;
    const ViewMapping mapping = mapping_from(centre, view, position, focal_px);
    for_each_sampled(view, mapping, [&](const Imath::V2i &q, const Imath::V2d &landed) {
        if (!(landed.x >= inside.min.x && landed.x < inside.max.x + 1.0 && landed.y >= inside.min.y &&
              landed.y < inside.max.y + 1.0))
            return;
        const Imath::V2i p(int(std::floor(landed.x)), int(std::floor(landed.y)));
        const double in_front =
            perceptive_depth(scale, in_view.depth(q)) - perceptive_depth(scale, in_centre.depth(p));
        const bool nothing = !in_centre.show_something(p);
        ++compared;
        if (!nothing && in_front < -same_depth) return; // hidden from the centre, as it may be
        sum += nothing || in_front > same_depth ? 1 : relative_difference(p, q);
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
