#include "warp/matting/thin_structures.h"

#include "deep/mixed_pixels.h"
#include "lens/lamp_spread.h"
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
        if (std::abs(samples.depth_of(i) - depth) > apart || !samples.is_opaque(i)) return;
        if (const double light = brightness(samples, i); std::isfinite(light)) strands.push_back({light, i});
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
        if (const double light = colour.length(); std::isfinite(light)) strands.push_back({i, colour, light});
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
    const Strand *strand;
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
        if (mix && (!least || mix->share < least->share)) least = {mix->share, &strand};
    }
    return least;
}

// The share of a strand, or less of it if the rest of the colour would be less than no light in a channel.
double lit_share(const Imath::V3d &colour, const Share &found) {
    double share = found.share;
    for (int k = 0; k < 3; ++k)
        if (const double light = found.strand->colour[k]; share * light > colour[k])
            share = std::max(colour[k], 0.0) / light;
    return share < least_mixed_share ? 0 : share;
}

// Something farther than strands, which may be behind them in a pixel.
struct Ground {
    double depth; // disparity
    Imath::V3d colour;
    std::optional<std::uint64_t> sample = {}; // of the view, if it shows the colour
};

std::vector<Ground> grounds_around(const SamplesAround &samples, int x, int y, int reach,
                                   double strand_depth) {
    std::vector<Ground> grounds;
    samples.around(x, y, reach, [&](std::uint64_t i, int, int) {
        if (samples.depth_of(i) <= strand_depth - WarpTuning::strand_apart_px && samples.is_opaque(i))
            grounds.push_back({samples.depth_of(i), samples.colour_of(i), i});
    });
    return grounds;
}

// The same surfaces, each once, with the colours that other views show of them behind the pixel.
std::vector<Ground> grounds_elsewhere(const BackgroundFromViews &others, int x, int y,
                                      std::span<const Ground> around) {
    std::vector<Ground> grounds;
    std::vector<double> asked; // depths
    for (const Ground &ground : around) {
        const auto is_same = [&](double depth) {
            return std::abs(depth - ground.depth) < WarpTuning::strand_apart_px;
        };
        if (std::ranges::any_of(asked, is_same)) continue;
        asked.push_back(ground.depth);
        if (const auto colour =
                others.colour_behind(Position(x, y), ground.depth, WarpTuning::strand_apart_px))
            grounds.push_back({ground.depth, *colour});
    }
    return grounds;
}

// How strands mix with each ground, and the median of these by share.
std::optional<Mixture> mixture_with(std::span<const Ground> grounds, const Imath::V3d &colour,
                                    std::span<const Strand> strands, double strand_depth) {
    struct Way {
        Share least;
        const Ground *ground;
    };
    std::vector<Way> ways;
    for (const Ground &ground : grounds)
        if (const auto least = least_share(colour, strands, ground.colour)) ways.push_back({*least, &ground});
    if (ways.empty()) return {};
    const auto middle = ways.begin() + std::ptrdiff_t(ways.size() / 2);
    std::ranges::nth_element(ways, middle, {}, [](const Way &way) { return way.least.share; });
    const auto &[least, ground] = *middle;
    if (ground->sample) return Mixture{strand_depth, ground->depth, least.share, {{*ground->sample, 1}}};
    return Mixture{strand_depth, ground->depth, lit_share(colour, least), {}, least.strand->sample};
}

} // namespace

bool among_strands(const SamplesAround &samples, int x, int y) {
    const ArrayGrid &grid = samples.grid();
    const auto jumps = [&](std::uint64_t i, int dx, int dy) {
        if (dx > WarpTuning::strand_reach || dy > WarpTuning::strand_reach ||
            !grid.contains(Position(x + dx, y + dy)))
            return false;
        if (samples.is_empty(grid.index(Position(x + dx, y + dy)))) return false;
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
                                             double apart, const BackgroundFromViews *others) {
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
    if (is_strand && others)
        if (const auto seen =
                others->brightest_at(Position(x, y), samples.depth_of(*lamp), near_depth - apart))
            if (stands_out(c, *seen)) return {};
    const double b = brightness(samples, *lamp), lamp_depth = samples.depth_of(*lamp);
    // A lamp's own pixel stays at its depth; a pixel of what is beside the lamp takes the lamp's depth.
    if (!is_strand) {
        const bool is_lamp = std::abs(own_depth - lamp_depth) < jump;
        return Mixture{near_depth, is_lamp ? own_depth : lamp_depth, 0, {}, strand};
    }
    const double share = b > c ? (b - c) / (b - f) : 0;
    return Mixture{near_depth, lamp_depth, share < least_mixed_share ? 0 : share, {}, strand};
}

std::optional<Mixture> strands_before(const SamplesAround &samples, int x, int y,
                                      const BackgroundFromViews *others) {
    const std::uint64_t own = samples.own_sample(x, y);
    const double own_depth = samples.depth_of(own), nearest = nearest_beside(samples, x, y);
    const double near_depth = own_depth > nearest - WarpTuning::strand_apart_px ? own_depth : nearest;
    const int reach = others ? 1 : WarpTuning::strand_reach; // a view alone needs more pixels to tell
    const std::vector<Ground> around = grounds_around(samples, x, y, reach, near_depth);
    if (around.empty()) return {};
    const Imath::V3d colour = samples.colour_of(own);
    const std::vector<Strand> strands = unlit_strands(samples, x, y, near_depth);
    if (others)
        if (const auto mixture =
                mixture_with(grounds_elsewhere(*others, x, y, around), colour, strands, near_depth))
            return mixture;
    return mixture_with(around, colour, strands, near_depth);
}

BackgroundFromViews::BackgroundFromViews(std::span<const ViewSamples> views,
                                         std::span<const ViewMapping> mappings, std::size_t own, double scale)
    : views_(views), mappings_(mappings), own_(own), scale_(scale), rgb_(find_rgb(views[own].channels)),
      alpha_(views[own].alpha()) {}

Imath::V3d BackgroundFromViews::colour_of(const ViewSamples &samples, std::size_t pixel) const {
    const auto value = [&](std::size_t k) { return double(samples.value(rgb_[k], pixel)); };
    return {value(0), value(1), value(2)};
}

// Calls visit(view, pixel) for the pixels of the other flat views, not on their border, that look at that depth along
// the ray of the own view's pixel.
template <typename Visit>
void BackgroundFromViews::for_each_other(const Position &pixel, double depth, const Visit &visit) const {
    const Imath::V2d middle = Imath::V2d(views_[own_].windows.grid().pixel(pixel)) + Imath::V2d(0.5);
    const Imath::V2d in_centre =
        mappings_[own_].at_infinity(middle) + depth / scale_ * mappings_[own_].parallax(middle);
    for (std::size_t v = 0; v < views_.size(); ++v) {
        if (v == own_ || views_[v].deep()) continue;
        const Imath::Box2i &data = views_[v].windows.data;
        const Imath::V2d seen = mappings_[v].in_view(in_centre, depth / scale_);
        if (seen.x >= data.min.x + 1 && seen.x < data.max.x && seen.y >= data.min.y + 1 &&
            seen.y < data.max.y)
            visit(views_[v],
                  views_[v].windows.index(Imath::V2i(int(std::floor(seen.x)), int(std::floor(seen.y)))));
    }
}

BackgroundFromViews::Around BackgroundFromViews::around(const ViewSamples &samples, std::size_t pixel) const {
    const std::size_t row = std::size_t(samples.windows.width());
    Around all;
    for (const std::size_t line : {pixel - row, pixel, pixel + row})
        for (const std::size_t i : {line - 1, line, line + 1}) {
            if (samples.pixel(i).empty()) continue;
            all.nearest = std::max(all.nearest, disparity(scale_, double(samples.z(i))));
            all.brightest = std::max(all.brightest, colour_of(samples, i).length());
        }
    return all;
}

std::optional<double> BackgroundFromViews::brightest_at(const Position &pixel, double depth,
                                                        double nearest) const {
    std::optional<double> brightest;
    for_each_other(pixel, depth, [&](const ViewSamples &samples, std::size_t seen) {
        const Around all = around(samples, seen);
        if (all.nearest < nearest) brightest = std::max(brightest.value_or(0), all.brightest);
    });
    return brightest;
}

bool BackgroundFromViews::see_past(const Position &pixel, double depth) const {
    bool past = false;
    for_each_other(pixel, depth, [&](const ViewSamples &samples, std::size_t seen) {
        past = past || (!samples.pixel(seen).empty() &&
                        around(samples, seen).nearest < depth - double(one_surface_px));
    });
    return past;
}

std::optional<Imath::V3d> BackgroundFromViews::colour_behind(const Position &pixel, double depth,
                                                             double apart) const {
    Imath::V3d sum(0, 0, 0);
    int count = 0;
    for_each_other(pixel, depth, [&](const ViewSamples &samples, std::size_t seen) {
        if (samples.pixel(seen).empty() || !is_opaque(alpha_at(samples, alpha_, seen))) return;
        if (!(std::abs(disparity(scale_, double(samples.z(seen))) - depth) < apart)) return;
        if (!(around(samples, seen).nearest < depth + apart)) return;
        sum += colour_of(samples, seen);
        ++count;
    });
    if (count == 0) return {};
    return sum / count;
}

} // namespace sparselens
