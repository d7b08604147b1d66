#include "warp/mixed/wisps.h"

#include "deep/unmixing.h"
#include "lens/lamp.h"
#include "warp/tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
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

struct Strand {
    std::uint64_t sample;
    Imath::V3d colour;
    double brightness;
};

// The strands at that depth around, without those that a lamp shines through. Farther ones are neighbours of each other
// that tell the same: every other one will do, along rows and along columns.
std::vector<Strand> unlit_strands(const SamplesAround &samples, int x, int y, double depth) {
    std::vector<Strand> strands;
    samples.around(x, y, WarpTuning::strand_colour_reach, [&](std::uint64_t i, int dx, int dy) {
        if (std::max(std::abs(dx), std::abs(dy)) > WarpTuning::strand_reach && (dx % 2 || dy % 2)) return;
        if (std::abs(samples.depth_of(i) - depth) > WarpTuning::strand_apart_px || !samples.is_opaque(i))
            return;
        const Imath::V3d colour = samples.colour_of(i);
        strands.push_back({i, colour, colour.length()});
    });
    if (strands.size() < 3) return strands;
    const auto dim = strands.begin() + std::ptrdiff_t(WarpTuning::dim_strand * double(strands.size()));
    std::ranges::nth_element(strands, dim, {}, &Strand::brightness);
    const double dimness = dim->brightness;
    std::erase_if(strands, [&](const Strand &strand) { return stands_out(strand.brightness, dimness); });
    return strands;
}

// The strand whose share of the colour is the smallest before `behind`, of those that explain it.
struct Share {
    double share;
    std::uint64_t strand;
};
std::optional<Share> least_share(const Imath::V3d &colour, std::span<const Strand> strands,
                                 const Imath::V3d &behind) {
    const Imath::V3d offset = colour - behind;
    const double off2 = offset.length2(),
                 most2 = WarpTuning::strand_residual * WarpTuning::strand_residual * colour.length2();
    std::optional<Share> least;
    for (const Strand &strand : strands) {
        const Imath::V3d across = strand.colour - behind;
        const double along = offset.dot(across), across2 = across.length2();
        // What unmix() would refuse, for most strands, or would find a larger share for.
        if (off2 * across2 - along * along > most2 * across2) continue;
        if (least && along >= least->share * across2) continue;
        const auto mix = unmix(colour, strand.colour, behind, no_prior, std::sqrt(most2 / across2));
        if (mix && (!least || mix->share < least->share)) least = {mix->share, strand.sample};
    }
    return least;
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

std::optional<Mixture> strands_before(const SamplesAround &samples, int x, int y, const OtherViews *others) {
    const std::uint64_t own = samples.own_sample(x, y);
    const double own_depth = samples.depth_of(own), nearest = nearest_beside(samples, x, y);
    const double near_depth = own_depth > nearest - WarpTuning::strand_apart_px ? own_depth : nearest;
    const Imath::V3d colour = samples.colour_of(own);
    std::vector<Strand> strands;
    std::vector<Mixture> all;
    const auto add = [&](double depth, const Imath::V3d &behind, const std::vector<Term> &terms) {
        if (strands.empty()) strands = unlit_strands(samples, x, y, near_depth);
        const auto least = least_share(colour, strands, behind);
        if (!least) return;
        all.push_back({near_depth, depth, least->share, terms, {}});
        if (terms.empty()) all.back().front = least->strand;
    };
    const auto around = [&](const auto &visit) {
        samples.around(x, y, WarpTuning::strand_reach, [&](std::uint64_t i, int, int) {
            if (samples.depth_of(i) <= near_depth - WarpTuning::strand_apart_px && samples.is_opaque(i))
                visit(i);
        });
    };
    std::vector<double> asked;
    if (others)
        around([&](std::uint64_t i) {
            const double depth = samples.depth_of(i);
            if (std::ranges::any_of(
                    asked, [&](double d) { return std::abs(d - depth) < WarpTuning::strand_apart_px; }))
                return;
            asked.push_back(depth);
            if (const auto behind = others->colour_behind({x, y}, depth, WarpTuning::strand_apart_px))
                add(depth, *behind, {});
        });
    if (all.empty())
        around([&](std::uint64_t i) { add(samples.depth_of(i), samples.colour_of(i), {{i, 1}}); });
    if (all.empty()) return {};
    const auto middle = all.begin() + std::ptrdiff_t(all.size() / 2);
    std::ranges::nth_element(all, middle, {}, &Mixture::share);
    return *middle;
}

} // namespace sparselens
