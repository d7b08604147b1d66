#include "warp/images/image_sweep.h"

#include "base/median.h"
#include "warp/images/patch_comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace sparselens {

namespace {

constexpr double step = 0.5;            // pixels of perceptive depth
constexpr double behind_camera = 6;     // pixels of perceptive depth below 0 that are searched
constexpr std::size_t most_steps = 160; // the surface is nearer than any that matters: larger steps
constexpr float least_distance = 0.25f; // from the surface: less is not worth it
constexpr float margin = 0.5f; // of the difference at the surface: what explains the views leaves less
constexpr float least_difference = 3e-5f; // at the surface, R, G and B together: less is not seen
constexpr float valley = 1.25f;           // one step and a half away the difference is so much larger
constexpr float rival = 1.4f;             // another valley is so much less deep
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

// The surface that most pixels of the block show, at the middle one of their depths; NaN if there is none.
float surface_of(const MatchedView &centre, const Imath::Box2i &block) {
    std::vector<float> depths;
    for (int y = block.min.y; y <= block.max.y; ++y)
        for (int x = block.min.x; x <= block.max.x; ++x)
            if (const float depth = centre.depth(x, y); !std::isnan(depth)) depths.push_back(depth);
    if (depths.empty()) return unknown;
    return median(depths);
}

// By step and pixel of a block.
class Curves {
public:
    Curves(std::size_t steps, std::size_t pixels) : pixels_(pixels), values_(steps * pixels) {}
    float &at(std::size_t k, std::size_t pixel) { return values_[k * pixels_ + pixel]; }
    float at(std::size_t k, std::size_t pixel) const { return values_[k * pixels_ + pixel]; }
    std::span<float> step_of(std::size_t k) { return std::span(values_).subspan(k * pixels_, pixels_); }

private:
    std::size_t pixels_;
    std::vector<float> values_;
};

// The depths that are tried, in equal steps.
struct Depths {
    double first, by;
    std::size_t count;

    explicit Depths(float surface) : first(-behind_camera) {
        const double last = 1.5 * double(surface) + behind_camera;
        by = std::max(step, (last - first) / double(most_steps - 1));
        count = std::size_t((last - first) / by) + 1;
    }
    double at(double k) const { return first + by * k; }
};

// The place of the least of three values in equal steps, on the parabola through them, from the middle one: [-1/2, 1/2].
double least_of_parabola(double before, double middle, double after) {
    const double bend = before - 2 * middle + after;
    return bend > 0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0;
}

// The difference of each pixel of a block at steps of depth, the robust mean over the rim views.
// compare(comparison, k, out) compares the block with one view at step k.
template <class Compare>
Curves mean_curves(std::span<const MatchedView> views, double scale, const Imath::Box2i &block, float surface,
                   std::size_t steps, const Compare &compare) {
    const std::size_t pixels = Grid(block).size(), rims = views.size() - 1;
    std::vector<Curves> by_view(rims, Curves(steps, pixels));
    for (std::size_t v = 0; v < rims; ++v) {
        PatchComparison comparison(views[0], views[v + 1], scale, block, surface);
        for (std::size_t k = 0; k < steps; ++k) compare(comparison, k, by_view[v].step_of(k));
    }
    Curves mean(steps, pixels);
    std::vector<float> of_views(rims);
    for (std::size_t k = 0; k < steps; ++k)
        for (std::size_t i = 0; i < pixels; ++i) {
            for (std::size_t v = 0; v < rims; ++v) of_views[v] = by_view[v].at(k, i);
            mean.at(k, i) = robust_mean(of_views);
        }
    return mean;
}

// Whether the curve has one clear valley; then its step.
std::optional<double> valley_of(const Curves &curve, std::size_t count, std::size_t pixel, float at_surface) {
    const auto value = [&](std::size_t k) { return curve.at(k, pixel); };
    std::size_t best = npos;
    for (std::size_t k = 0; k < count; ++k)
        if (!std::isnan(value(k)) && (best == npos || value(k) < value(best))) best = k;
    if (best == npos || best < 3 || best + 3 >= count || !(value(best) <= margin * at_surface)) return {};
    constexpr float rounding = 1e-7f;
    const float high = valley * value(best) + rounding;
    if (!(value(best - 3) > high && value(best + 3) > high)) return {};
    for (std::size_t k = 1; k + 1 < count; ++k) {
        const bool beside = k + 4 > best && k < best + 4;
        if (!beside && value(k) <= value(k - 1) && value(k) <= value(k + 1) &&
            value(k) < rival * value(best) + rounding)
            return {};
    }
    return double(best) + least_of_parabola(value(best - 1), value(best), value(best + 1));
}

} // namespace

float robust_mean(std::span<float> differences) {
    const auto unknowns = // ranges::partition() returns what clang 14 cannot compile
        std::partition(differences.begin(), differences.end(), [](float d) { return !std::isnan(d); });
    const auto known = std::size_t(unknowns - differences.begin());
    if (known == 0 || 2 * known < differences.size()) return unknown;
    const auto best = differences.first(known).first((3 * known + 3) / 4);
    std::ranges::sort(differences.first(known));
    return std::reduce(best.begin(), best.end()) / float(best.size());
}

std::vector<ImageMatch> ImageSweep::search(const Imath::Box2i &block) const {
    const MatchedView &centre = views_[0];
    const Grid grid(block);
    std::vector<ImageMatch> matches(grid.size());
    const float surface = surface_of(centre, block);
    if (std::isnan(surface)) return matches;
    const Curves at_surface = mean_curves( // one step
        views_, scale_, block, surface, 1,
        [&](PatchComparison &comparison, std::size_t, std::span<float> out) {
            comparison.at_depths([&](const Imath::V2i &p) { return double(centre.depth(p.x, p.y)); }, out);
        });
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const Imath::V2i p = grid.pixel(i);
        const float own = centre.depth(p.x, p.y);
        if (!kernels::is_one_surface(own, surface, one_mirror_px)) continue;
        ImageMatch &match = matches[i];
        match.own_depth = own;
        match.at_surface = at_surface.at(0, i);
        match.surface = !std::isnan(match.at_surface);
    }
    const auto worth_it = [](const ImageMatch &m) { return m.surface && m.at_surface >= least_difference; };
    if (std::ranges::none_of(matches, worth_it)) return matches; // most edges of texture, once smoothed
    const Depths depths(surface);
    const Curves curve = mean_curves(views_, scale_, block, surface, depths.count,
                                     [&](PatchComparison &comparison, std::size_t k, std::span<float> out) {
                                         comparison.at_depth(depths.at(double(k)), out);
                                     });
    for (std::size_t i = 0; i < grid.size(); ++i) {
        ImageMatch &match = matches[i];
        if (!worth_it(match)) continue;
        if (const auto k = valley_of(curve, depths.count, i, match.at_surface)) {
            match.depth = float(depths.at(*k));
            match.found = std::abs(match.depth - match.own_depth) >= least_distance;
        }
    }
    return matches;
}

std::vector<float> ImageSweep::refined(const Imath::Box2i &block,
                                       const std::function<float(const Imath::V2i &)> &depth_at) const {
    constexpr int side = 3; // steps on either side
    constexpr double by = 0.25;
    const MatchedView &centre = views_[0];
    const Grid grid(block);
    std::vector<float> refined(grid.size(), unknown);
    bool known = false;
    for (std::size_t i = 0; i < grid.size() && !known; ++i) known = !std::isnan(depth_at(grid.pixel(i)));
    const float surface = known ? surface_of(centre, block) : unknown;
    if (std::isnan(surface)) return refined;
    constexpr std::size_t steps = 2 * side + 1;
    const Curves curves = mean_curves(
        views_, scale_, block, surface, steps,
        [&](PatchComparison &comparison, std::size_t k, std::span<float> out) {
            comparison.at_depths(
                [&](const Imath::V2i &p) { return double(depth_at(p)) + by * (double(k) - side); }, out);
        });
    std::array<float, steps> curve;
    for (std::size_t i = 0; i < grid.size(); ++i) {
        for (std::size_t k = 0; k < steps; ++k) curve[k] = curves.at(k, i);
        const std::size_t best = std::size_t(std::ranges::min_element(curve) - curve.begin());
        const bool inside = best > 0 && best + 1 < steps &&
                            std::ranges::none_of(curve, [](float c) { return std::isnan(c); });
        const double moved = inside ? by * (double(best) - side +
                                            least_of_parabola(curve[best - 1], curve[best], curve[best + 1]))
                                    : 0;
        refined[i] = float(double(depth_at(grid.pixel(i))) + moved);
    }
    return refined;
}

std::vector<float> ImageSweep::differences(const Imath::V2i &pixel, double depth) const {
    const Imath::Box2i block(pixel, pixel);
    const float surface = surface_of(views_[0], block);
    std::vector<float> differences;
    for (const MatchedView &view : views_.subspan(1)) {
        float difference = unknown;
        if (!std::isnan(surface))
            PatchComparison(views_[0], view, scale_, block, surface)
                .at_depth(depth, std::span(&difference, 1));
        differences.push_back(difference);
    }
    return differences;
}

} // namespace sparselens
