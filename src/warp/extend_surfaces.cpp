#include "warp/extend_surfaces.h"

#include "base/light.h"
#include "base/parallel.h"
#include "deep/build.h"
#include "kernels/surface.h"
#include "lens/thin_lens.h"
#include "warp/lamps/lamp_light.h"
#include "warp/tuning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace sparselens {

namespace {

constexpr std::array<std::array<int, 2>, 4> steps{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

// A surface that continues along a row or a column.
struct Run {
    Imath::V2i end;       // the last pixel that shows the surface
    std::uint64_t sample; // there
    Imath::V2i step;      // from pixel to pixel
    int length;           // pixels after the end
};

// A pixel of a run.
struct Hidden {
    std::size_t pixel;
    int distance; // from the end of the surface, pixels
    double depth; // disparity
    std::array<std::uint64_t, 2> shown;
    auto order() const { return std::tuple(pixel, distance, depth, shown); }
};

// Marks the samples of small lamps, in front of others or behind them.
std::vector<bool> samples_of_lamps(const Ldi &ldi) {
    const auto rgb = find_rgb(ldi.channels);
    std::vector<bool> marks(ldi.samples());
    if (!all_found(rgb)) return marks;
    const auto light = [&](std::uint64_t i) {
        float sum = 0;
        for (const std::size_t k : rgb) sum += ldi.values[k][i];
        return sum;
    };
    std::vector<float> brightest(ldi.windows.pixels());
    parallel_ranges(brightest.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            for (const std::uint64_t i : ldi.pixel(p)) brightest[p] = std::max(brightest[p], light(i));
    });
    for (const CompactLamp &lamp : find_compact_lamps(ldi.windows.grid(), brightest))
        for (const Imath::V2i &at : lamp.pixels)
            for (const std::uint64_t i : ldi.pixel(ldi.windows.index(at.x, at.y)))
                marks[i] = light(i) > lamp.limit;
    return marks;
}

class SurfaceExtension {
public:
    SurfaceExtension(const Ldi &ldi, const Imath::Box2i &frame, double scale)
        : ldi_(ldi), frame_(frame), scale_(scale), alpha_(ldi.alpha()), lamps_(samples_of_lamps(ldi)) {}

    // The runs of a row of pixels that continue for a pixel or more. `may_be(hidden)`: whether no view contradicts.
    template <typename MayBe>
    std::vector<Run> runs_of(int y, const MayBe &may_be) const {
        std::vector<Run> runs;
        for (int x = frame_.min.x; x <= frame_.max.x; ++x)
            for (const std::uint64_t i : ldi_.pixel(ldi_.windows.index(x, y))) {
                if (!is_surface(i) || lamps_[i]) continue;
                for (const auto &[right, down] : steps) {
                    Run run{
                        {x, y}, i, {right, down}, frame_.max.x - frame_.min.x + frame_.max.y - frame_.min.y};
                    if (surface_at(run.end + run.step, depth_of(i))) continue;
                    run.length = follow(run, may_be);
                    if (run.length > 0) runs.push_back(run);
                }
            }
        return runs;
    }
    // Calls visit(Hidden) for the pixels of a run, until it returns false. Returns for how many it returned true.
    template <typename Visit>
    int follow(const Run &run, const Visit &visit) const {
        const double end = depth_of(run.sample);
        std::uint64_t before = run.sample; // the n-th pixel before the end shows it
        for (int n = 1; n <= run.length; ++n) {
            const auto at_distance = [&](int m) {
                return surface_at(run.end - m * run.step, depth_of(before));
            };
            // Where a view looks at a surface from the side, a pixel may have no sample of it.
            const auto found = at_distance(n);
            if (!found && !at_distance(n + 1)) return n - 1;
            before = found.value_or(before);
            const Imath::V2i at = run.end + n * run.step;
            const double depth = 2 * end - depth_of(before);
            if (!is_between(at, depth, n)) return n - 1;
            const Hidden hidden{
                ldi_.windows.index(at.x, at.y), n, depth, {run.sample, lamps_[before] ? run.sample : before}};
            if (!visit(hidden)) return n - 1;
        }
        return run.length;
    }

private:
    double depth_of(std::uint64_t i) const { return disparity(scale_, double(ldi_.z[i])); }
    bool covers(std::uint64_t i) const { return alpha_at(ldi_, alpha_, i) >= half_covered; }
    bool is_surface(std::uint64_t i) const {
        return covers(i) && std::isfinite(ldi_.z[i]) && ldi_.coc_z(i) == double(ldi_.z[i]) &&
               back_at(ldi_, i) == ldi_.z[i];
    }
    // The sample of a pixel that is nearest to a depth, if it shows the surface that has this depth beside it.
    std::optional<std::uint64_t> surface_at(const Imath::V2i &at, double depth) const {
        if (!frame_.intersects(at)) return {};
        std::optional<std::uint64_t> nearest;
        double least = double(one_surface_px);
        for (const std::uint64_t i : ldi_.pixel(ldi_.windows.index(at.x, at.y)))
            if (const double apart = std::abs(depth_of(i) - depth); apart <= least && is_surface(i)) {
                nearest = i;
                least = apart;
            }
        return nearest;
    }
    // Whether a surface lies, n pixels after its end, between something nearer and something farther, and a lens point
    // may look there.
    bool is_between(const Imath::V2i &at, double depth, int n) const {
        if (!(depth > 0) || !frame_.intersects(at) || surface_at(at, depth)) return false;
        const SampleRange there = ldi_.pixel(ldi_.windows.index(at.x, at.y));
        if (there.empty() || depth_of(there.to - 1) >= depth) return false;
        double nearer = 0; // by how much the farthest sample before it is nearer
        for (const std::uint64_t i : there)
            if (covers(i) && depth_of(i) > depth) nearer = depth_of(i) - depth;
        return double(n - 1) < std::numbers::sqrt2 * nearer;
    }

    const Ldi &ldi_;
    Imath::Box2i frame_;
    double scale_;
    std::size_t alpha_;
    std::vector<bool> lamps_; // [sample]
};

// The runs that no view contradicts, of each row of pixels.
std::vector<std::vector<Run>> find_runs(std::span<const PlacedView> views, double scale, const Ldi &ldi,
                                        const Imath::Box2i &frame, const SurfaceExtension &extension) {
    std::vector<std::vector<Run>> rows(std::size_t(frame.max.y - frame.min.y + 1));
    for (const PlacedView &view : views) {
        const FarthestDepth sight = farthest_around(*view.samples, farthest_in(*view.samples));
        const auto may_be = [&](const Hidden &hidden) {
            const Imath::V2d middle = Imath::V2d(ldi.windows.pixel(hidden.pixel)) + Imath::V2d(0.5, 0.5);
            const auto farthest = sight.at(view.mapping->in_view(middle, hidden.depth / scale));
            return !farthest || double(*farthest) * scale >= hidden.depth - double(one_surface_px);
        };
        parallel_for(rows.size(), [&](std::size_t row) {
            if (&view == &views.front())
                rows[row] = extension.runs_of(frame.min.y + int(row), may_be);
            else
                for (Run &run : rows[row]) run.length = extension.follow(run, may_be);
        });
    }
    return rows;
}

// A sample that is added.
struct Added {
    std::size_t pixel;
    double depth;            // disparity
    std::vector<Term> terms; // their coefficients are weights
    auto order() const { return std::pair(pixel, -depth); }
};

// The samples of all runs, in the order that samples have.
std::vector<Added> samples_of(std::vector<Hidden> all) {
    std::ranges::sort(all, {}, &Hidden::order);
    std::vector<Added> added;
    for (const Hidden &hidden : all) {
        auto same = added.end();
        for (auto a = added.end(); a != added.begin() && std::prev(a)->pixel == hidden.pixel; --a)
            if (std::abs(std::prev(a)->depth - hidden.depth) <= double(torn_px)) same = std::prev(a);
        if (same == added.end()) same = added.insert(same, {hidden.pixel, hidden.depth, {}});
        for (const std::uint64_t i : hidden.shown) same->terms.push_back({i, 1.0 / hidden.distance});
    }
    std::ranges::sort(added, {}, &Added::order);
    return added;
}

void add(std::vector<Added> all, double scale, Ldi &ldi) {
    Ldi added = empty_like(ldi);
    added.begin.assign(1, 0);
    std::vector<SamplePlace> places;
    const std::size_t alpha = ldi.alpha();
    for (Added &one : all) {
        const float z = float(depth_at_disparity(scale, one.depth));
        double weights = 0;
        for (const Term &term : one.terms) weights += term.coefficient;
        for (Term &term : one.terms) term.coefficient /= weights * double(alpha_at(ldi, alpha, term.index));
        append(added, ldi, MergedSample{z, z, 0, 0, 1, z, 0, one.terms});
        std::uint64_t before = ldi.pixel(one.pixel).from;
        while (before < ldi.pixel(one.pixel).to && ldi.z[before] <= z) ++before;
        places.push_back({one.pixel, before});
    }
    insert_samples(ldi, places, added);
}

} // namespace

void extend_surfaces(std::span<const PlacedView> views, double scale, Ldi &ldi) {
    const Imath::Box2i frame = views[0].samples->windows.data;
    const SurfaceExtension extension(ldi, frame, scale);
    std::vector<Hidden> hidden;
    for (const std::vector<Run> &row : find_runs(views, scale, ldi, frame, extension))
        for (const Run &run : row)
            extension.follow(run, [&](const Hidden &one) {
                hidden.push_back(one);
                return true;
            });
    add(samples_of(std::move(hidden)), scale, ldi);
}

namespace {

// Pixels: how far a lens point moves a solid relative to its sample, plus the margin.
constexpr int reach = int(WarpTuning::solid_px) + WarpTuning::sight_margin;

// By how much the largest and the least 1 / z within reach differ.
FarthestDepth relief_around(const ViewSamples &view, std::vector<float> farthest) {
    const Grid grid(view.windows.data);
    std::vector<float> relief = least_around(farthest, grid, reach);
    for (float &v : farthest) v = -v;
    std::ranges::transform(least_around(farthest, grid, reach), relief, relief.begin(),
                           [](float nearest, float least) { return -nearest - least; });
    return {view, std::move(relief)};
}

// Returns the first sample that covers half of a pixel or more; if there is none, the end of the pixel's samples.
std::uint64_t front_of(const Ldi &ldi, std::size_t alpha, std::size_t pixel) {
    const SampleRange all = ldi.pixel(pixel);
    std::uint64_t i = all.from;
    while (i < all.to && !(alpha_at(ldi, alpha, i) >= half_covered)) ++i;
    return i;
}

// Some of the pixels of an LDI.
class Pixels {
public:
    explicit Pixels(const Ldi &ldi) : ldi_(ldi), alpha_(ldi.alpha()), in_(ldi.windows.pixels(), true) {}

    // Keeps the pixels for whose front sample keeps(sample, its position) is true.
    template <typename Keeps>
    void keep(const Keeps &keeps) {
        parallel_for(std::size_t(ldi_.windows.height()), [&](std::size_t row) {
            const std::size_t width = std::size_t(ldi_.windows.width());
            for (std::size_t p = row * width; p < (row + 1) * width; ++p)
                in_[p] = in_[p] && keeps_front(p, keeps);
        });
    }
    // Calls visit(front sample) for each of the pixels, in order.
    template <typename Visit>
    void for_each(const Visit &visit) const {
        for (std::size_t p = 0; p < in_.size(); ++p)
            if (in_[p]) visit(front_of(ldi_, alpha_, p));
    }

private:
    template <typename Keeps>
    bool keeps_front(std::size_t pixel, const Keeps &keeps) const {
        const std::uint64_t i = front_of(ldi_, alpha_, pixel);
        if (i == ldi_.pixel(pixel).to) return false;
        const MergedSample s = sample_at(ldi_, i);
        return keeps(s, Imath::V2d(ldi_.windows.pixel(pixel)) +
                            Imath::V2d(0.5 + double(s.dx), 0.5 + double(s.dy)));
    }
    const Ldi &ldi_;
    std::size_t alpha_;
    std::vector<char> in_;
};

} // namespace

void find_solids(std::span<const PlacedView> views, double scale, Ldi &ldi) {
    const double step = inverse_depth_step(scale, 1), thickness = WarpTuning::solid_px * step;
    const auto back = [&](const MergedSample &s) { return 1 / double(s.z) - thickness; };
    Pixels solid(ldi);
    for (const PlacedView &view : views) {
        std::vector<float> farthest_seen = farthest_in(*view.samples);
        const FarthestDepth sight = farthest_around(*view.samples, farthest_seen);
        if (&view == &views[0]) { // the centre view; few pixels are kept here
            const FarthestDepth relief = relief_around(*view.samples, std::move(farthest_seen));
            solid.keep([&](const MergedSample &s, const Imath::V2d &place) {
                return s.image_z == s.z && back(s) > thickness &&
                       double(relief.at(place).value_or(0)) > WarpTuning::solid_relief_px * step;
            });
        }
        solid.keep([&](const MergedSample &s, const Imath::V2d &place) {
            const std::optional<float> farthest = sight.at(view.mapping->in_view(place, back(s)));
            return !farthest || double(*farthest) - back(s) >= WarpTuning::solid_nearer_px * step;
        });
    }
    solid.for_each([&](std::uint64_t i) {
        if (ldi.solid.empty()) ldi.solid.assign(ldi.samples(), 0);
        ldi.solid[i] = float(thickness);
    });
}

namespace {

float farthest_in(const ViewSamples &view, std::size_t alpha, std::size_t pixel) {
    const SampleRange samples = view.pixel(pixel);
    return lets_through(view, alpha, samples) ? 0 : 1 / view.z(samples.to - 1);
}

} // namespace

std::vector<float> farthest_in(const ViewSamples &view) {
    std::vector<float> farthest(view.windows.pixels());
    const std::size_t alpha = view.alpha();
    parallel_ranges(farthest.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) farthest[p] = farthest_in(view, alpha, p);
    });
    return farthest;
}

// Along rows, then across them, a row at a time.
std::vector<float> least_around(const std::vector<float> &values, const Grid &grid, int radius) {
    const auto width = std::size_t(grid.width()), height = std::size_t(grid.height()),
               r = std::size_t(radius);
    std::vector<float> along_rows = values, least(values.size());
    const auto lower = [](float *to, const float *by, std::size_t count) {
        for (std::size_t x = 0; x < count; ++x) to[x] = std::min(to[x], by[x]);
    };
    parallel_for(height, [&](std::size_t y) {
        const float *from = &values[y * width];
        float *to = &along_rows[y * width];
        for (std::size_t n = 1; n <= std::min(r, width - 1); ++n) {
            lower(to, from + n, width - n);
            lower(to + n, from, width - n);
        }
    });
    parallel_for(height, [&](std::size_t y) {
        std::copy_n(&along_rows[y * width], width, &least[y * width]);
        for (std::size_t n = y - std::min(r, y); n <= std::min(y + r, height - 1); ++n)
            lower(&least[y * width], &along_rows[n * width], width);
    });
    return least;
}

FarthestDepth farthest_around(const ViewSamples &view, const std::vector<float> &farthest) {
    return {view, least_around(farthest, Grid(view.windows.data), WarpTuning::sight_margin)};
}

} // namespace sparselens
