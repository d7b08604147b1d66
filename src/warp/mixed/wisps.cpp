#include "warp/mixed/wisps.h"

#include "deep/unmixing.h"
#include "lens/lamp.h"
#include "warp/tuning.h"

#include <cmath>
#include <utility>

namespace sparselens {

namespace {

double brightness(const SamplesAround &samples, std::uint64_t i) { return samples.colour_of(i).length(); }

double nearest_beside(const SamplesAround &samples, int x, int y) {
    double nearest = 0;
    samples.around(x, y, 1,
                   [&](std::uint64_t i, int, int) { nearest = std::max(nearest, samples.depth_of(i)); });
    return nearest;
}

// The colour of unlit strands at that depth: a low percentile of those around.
std::optional<std::uint64_t> dim_one(const SamplesAround &samples, int x, int y, double depth, double apart) {
    std::vector<std::pair<double, std::uint64_t>> strands;
    samples.around(x, y, WarpTuning::strand_light_reach, [&](std::uint64_t i, int, int) {
        if (std::abs(samples.depth_of(i) - depth) <= apart && samples.is_opaque(i))
            strands.push_back({brightness(samples, i), i});
    });
    if (strands.size() < 3) return {};
    const auto middle = strands.begin() + std::ptrdiff_t(WarpTuning::dim_strand * double(strands.size()));
    std::nth_element(strands.begin(), middle, strands.end());
    return middle->second;
}

// The brightest pixel behind strands of that depth, if it is brighter than `least`.
std::optional<std::uint64_t> lamp_behind(const SamplesAround &samples, int x, int y, double depth,
                                         double apart, double least) {
    std::optional<std::uint64_t> lamp;
    samples.around(x, y, WarpTuning::strand_light_reach, [&](std::uint64_t i, int dx, int dy) {
        const double own = samples.depth_of(i);
        if ((dx == 0 && dy == 0) || own > depth - apart || own < WarpTuning::least_lamp_px) return;
        if (const double value = brightness(samples, i); value > least) {
            least = value;
            lamp = i;
        }
    });
    return lamp;
}

// Returns the colour of the strand at that depth that differs most from a given colour.
Imath::V3d most_different(const SamplesAround &samples, int x, int y, double depth, const Imath::V3d &from) {
    Imath::V3d result = from;
    samples.around(x, y, WarpTuning::strand_reach, [&](std::uint64_t i, int, int) {
        if (std::abs(samples.depth_of(i) - depth) > WarpTuning::strand_apart_px || !samples.is_opaque(i))
            return;
        if (const Imath::V3d c = samples.colour_of(i); (c - from).length2() > (result - from).length2())
            result = c;
    });
    return result;
}

} // namespace

bool among_strands(const SamplesAround &samples, int x, int y) {
    const Grid &grid = samples.grid();
    const auto jumps = [&](std::uint64_t i, int dx, int dy) {
        if (dx > WarpTuning::strand_reach || dy > WarpTuning::strand_reach || !grid.contains(x + dx, y + dy))
            return false;
        if (samples.is_empty(grid.index(x + dx, y + dy))) return false;
        return std::abs(samples.depth_of(samples.own_sample(x + dx, y + dy)) - samples.depth_of(i)) >
               WarpTuning::strand_apart_px;
    };
    int along = 0, down = 0;
    samples.around(x, y, WarpTuning::strand_reach, [&](std::uint64_t i, int dx, int dy) {
        along += jumps(i, dx + 1, dy);
        down += jumps(i, dx, dy + 1);
    });
    return std::min(along, down) >= WarpTuning::strand_jumps;
}

std::optional<Mixture> light_between_strands(const SamplesAround &samples, int x, int y, double jump,
                                             double apart) {
    const std::uint64_t own = samples.own_sample(x, y);
    const double own_depth = samples.depth_of(own), nearest = nearest_beside(samples, x, y);
    const bool is_strand = own_depth > nearest - apart;
    const double near_depth = is_strand ? own_depth : nearest;
    const auto strand = dim_one(samples, x, y, near_depth, apart);
    if (!strand) return {};
    const double c = brightness(samples, own), f = brightness(samples, *strand);
    if (!stands_out(c, f)) return {};
    const auto lamp = lamp_behind(samples, x, y, near_depth, apart, c / LampTuning::stands_out);
    if (!lamp) return {};
    const double b = brightness(samples, *lamp), lamp_depth = samples.depth_of(*lamp);
    // A lamp's own pixel stays at its depth; a pixel of what is beside the lamp takes the lamp's depth.
    if (!is_strand) {
        const bool is_lamp = std::abs(own_depth - lamp_depth) < jump;
        return Mixture{near_depth, is_lamp ? own_depth : lamp_depth, 0, {}, strand};
    }
    const double share = b > c ? (b - c) / (b - f) : 0;
    return Mixture{near_depth, lamp_depth, share < least_mixed_share ? 0 : share, {}, strand};
}

std::optional<Mixture> strands_before(const SamplesAround &samples, int x, int y) {
    const std::uint64_t own = samples.own_sample(x, y);
    const double own_depth = samples.depth_of(own), nearest = nearest_beside(samples, x, y);
    const double near_depth = own_depth > nearest - WarpTuning::strand_apart_px ? own_depth : nearest;
    std::optional<Mixture> best;
    samples.around(x, y, WarpTuning::strand_reach, [&](std::uint64_t i, int, int) {
        if (samples.depth_of(i) > near_depth - WarpTuning::strand_apart_px || !samples.is_opaque(i)) return;
        const Imath::V3d b = samples.colour_of(i);
        const Imath::V3d c = samples.colour_of(own), f = most_different(samples, x, y, near_depth, b);
        const auto mix =
            unmix(c, f, b, no_prior, WarpTuning::strand_residual * c.length() / (f - b).length());
        if (mix && (!best || mix->share > best->share))
            best = {near_depth, samples.depth_of(i), mix->share, {{i, 1}}};
    });
    return best;
}

} // namespace sparselens
