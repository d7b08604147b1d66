#include "warp/extend_surfaces.h"

#include "base/light.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "deep/build.h"
#include "deep/unseen.h"
#include "lens/thin_lens.h"
#include "warp/lamps/lamp_light.h"
#include "warp/tuning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace sparselens {

namespace {

// 1 / z of the farthest thing that each pixel of a view shows; 0: it lets light through to infinity.
std::vector<float> farthest_in(const ViewSamples &view) {
    std::vector<float> farthest(view.windows.pixels());
    const std::size_t alpha = view.alpha();
    parallel_ranges(farthest.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            const SampleRange samples = view.pixel(p);
            farthest[p] = lets_through(view, alpha, samples) ? 0 : 1 / view.z(samples.to - 1);
        }
    });
    return farthest;
}

// The least value in a square around each pixel. Along rows, then across them, a row at a time.
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

} // namespace

std::optional<float> Sights::OfPixels::at(const Imath::V2d &place) const {
    if (!(std::abs(place.x) < 1e9 && std::abs(place.y) < 1e9)) return {};
    const Imath::V2i pixel(int(std::floor(place.x)), int(std::floor(place.y)));
    if (grid.contains(pixel)) return values[grid.index(pixel)];
    return display.intersects(pixel) ? std::optional(0.0f) : std::nullopt;
}

Sights::Sights(ReprojectedViews &views, double scale_) : scale(scale_), frame(views.samples(0).windows.data) {
    for (std::size_t v = 0; v < views.size(); ++v) {
        const Windows windows = views.samples(v).windows;
        const Grid grid(windows.data);
        std::vector<float> farthest = farthest_in(views.samples(v));
        views.forget(v);
        farthest_.push_back(
            {&views.reprojection(v).mapping(),
             {windows.display, grid, least_around(farthest, grid, WarpTuning::sight_margin)}});
        if (v > 0) continue;
        // Pixels: how far a lens point moves a solid relative to its sample, plus the margin.
        constexpr int reach = int(WarpTuning::solid_px) + WarpTuning::sight_margin;
        relief_ = {windows.display, grid, least_around(farthest, grid, reach)};
        for (float &value : farthest) value = -value;
        std::ranges::transform(least_around(farthest, grid, reach), relief_.values, relief_.values.begin(),
                               [](float nearest, float least) { return -nearest - least; });
    }
}

bool Sights::are_hidden(const Imath::V2d &place, double depth, double nearer) const {
    return std::ranges::all_of(farthest_, [&](const auto &view) {
        const std::optional<float> farthest = view.second.at(view.first->in_view(place, depth / scale));
        return !farthest || double(*farthest) * scale >= depth + nearer;
    });
}

namespace {

// A pixel in which a surface continues.
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
            for (const std::uint64_t i : ldi.pixel(ldi.windows.index(at))) marks[i] = light(i) > lamp.limit;
    return marks;
}

class SurfaceExtension {
public:
    SurfaceExtension(const Sights &sights, const Ldi &ldi)
        : sights_(sights), frame_(sights.frame), ldi_(ldi), alpha_(ldi.alpha()),
          lamps_(samples_of_lamps(ldi)) {}

    // Where the surfaces of a row of pixels continue.
    std::vector<Hidden> from_row(int y) const {
        std::vector<Hidden> found;
        for (int x = frame_.min.x; x <= frame_.max.x; ++x)
            for (const std::uint64_t i : ldi_.pixel(ldi_.windows.index(Imath::V2i(x, y)))) {
                if (!is_surface(i) || lamps_[i]) continue;
                for (const Imath::V2i &step : sides_of_pixel)
                    if (!surface_at(Imath::V2i(x, y) + step, depth_of(i))) follow(i, {x, y}, step, found);
            }
        return found;
    }

private:
    // Continues the surface whose last pixel is `end`, where `sample` shows it.
    void follow(std::uint64_t sample, const Imath::V2i &end, const Imath::V2i &step,
                std::vector<Hidden> &found) const {
        const bool is_last = !has_farther(end, depth_of(sample));
        std::uint64_t before = sample; // the n-th pixel before the end shows it
        for (int n = 1;; ++n) {
            const auto at_distance = [&](int m) { return surface_at(end - m * step, depth_of(before)); };
            // Where a view looks at a surface from the side, a pixel may have no sample of it.
            const auto shown = at_distance(n);
            if (!shown && !at_distance(n + 1)) return;
            before = shown.value_or(before);
            const Imath::V2i at = end + n * step;
            const double depth = mirrored(depth_of(sample), depth_of(before));
            if (!is_behind(at, depth, n) || (is_last && !has_farther(at, depth)) ||
                !sights_.are_hidden(Imath::V2d(at) + Imath::V2d(0.5), depth, -double(one_surface_px)))
                return;
            found.push_back({ldi_.windows.index(at), n, depth, {sample, lamps_[before] ? sample : before}});
        }
    }
    double depth_of(std::uint64_t i) const { return disparity(sights_.scale, double(ldi_.z[i])); }
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
        for (const std::uint64_t i : ldi_.pixel(ldi_.windows.index(at)))
            if (const double apart = std::abs(depth_of(i) - depth); apart <= least && is_surface(i)) {
                nearest = i;
                least = apart;
            }
        return nearest;
    }
    // Whether a pixel has something farther.
    bool has_farther(const Imath::V2i &at, double depth) const {
        const SampleRange there = ldi_.pixel(ldi_.windows.index(at));
        return !there.empty() && depth_of(there.to - 1) < depth;
    }
    // Whether a surface lies, n pixels after its end, behind something nearer, and a lens point may look there.
    bool is_behind(const Imath::V2i &at, double depth, int n) const {
        if (!(depth > 0) || !frame_.intersects(at) || surface_at(at, depth)) return false;
        double nearer = 0; // by how much the farthest sample before it is nearer
        for (const std::uint64_t i : ldi_.pixel(ldi_.windows.index(at)))
            if (covers(i) && depth_of(i) > depth) nearer = depth_of(i) - depth;
        return is_seen_behind(n, nearer);
    }

    const Sights &sights_;
    Imath::Box2i frame_;
    const Ldi &ldi_;
    std::size_t alpha_;
    std::vector<bool> lamps_; // [sample]
};

std::vector<Hidden> find_hidden(const Sights &sights, const Ldi &ldi) {
    const SurfaceExtension extension(sights, ldi);
    return joined(std::size_t(sights.frame.max.y - sights.frame.min.y + 1),
                  [&](std::size_t row) { return extension.from_row(sights.frame.min.y + int(row)); });
}

// A sample that is added to a pixel.
struct Added {
    double depth;            // disparity
    std::vector<Term> terms; // their coefficients are weights
};

// The samples of all runs that continue into one pixel, front to back.
std::vector<Added> samples_of(std::span<const Hidden> of_pixel) {
    std::vector<Added> added;
    for (const Hidden &hidden : of_pixel) {
        const auto is_same = [&](const Added &a) {
            return std::abs(a.depth - hidden.depth) <= double(torn_px);
        };
        auto same = std::ranges::find_if(added, is_same);
        if (same == added.end()) same = added.insert(same, {hidden.depth, {}});
        for (const std::uint64_t i : hidden.shown) same->terms.push_back({i, 1.0 / hidden.distance});
    }
    std::ranges::sort(added, std::ranges::greater(), &Added::depth);
    return added;
}

void add(std::vector<Hidden> all, double scale, Ldi &ldi) {
    std::ranges::sort(all, {}, &Hidden::order);
    Ldi added = empty_like(ldi);
    added.begin.reserve(ldi.begin.size());
    added.begin.assign(1, 0);
    const std::size_t alpha = ldi.alpha();
    for (auto first = all.begin(); first != all.end();) {
        const std::size_t pixel = first->pixel;
        const auto end =
            std::ranges::find_if(first, all.end(), [&](const Hidden &h) { return h.pixel != pixel; });
        added.begin.resize(pixel + 2, added.begin.back());
        for (Added &one : samples_of({first, end})) {
            const float z = float(depth_at_disparity(scale, one.depth));
            double weights = 0;
            for (const Term &term : one.terms) weights += term.coefficient;
            for (Term &term : one.terms)
                term.coefficient /= weights * double(alpha_at(ldi, alpha, term.index));
            append(added, ldi, MergedSample{z, z, 0, 0, 1, z, 0, one.terms});
        }
        first = end;
    }
    all = {};
    added.begin.resize(ldi.begin.size(), added.begin.back());
    give_back_memory(); // that the search held
    insert_samples(ldi, added);
}

} // namespace

void extend_surfaces(Sights &&sights, Ldi &ldi) {
    const double scale = sights.scale;
    std::vector<Hidden> hidden = find_hidden(Sights(std::move(sights)), ldi); // frees the sights before add()
    add(std::move(hidden), scale, ldi);
}

void find_solids(const Sights &sights, Ldi &ldi) {
    const double step = inverse_depth_step(sights.scale, 1), thickness = WarpTuning::solid_px * step;
    const std::size_t alpha = ldi.alpha();
    const auto is_solid = [&](const MergedSample &s, const Imath::V2d &place) {
        const double back = 1 / double(s.z) - thickness;
        return s.image_z == s.z && back > thickness &&
               sights.relief_at(place) > WarpTuning::solid_relief_px * step &&
               sights.are_hidden(place, back * sights.scale, WarpTuning::solid_nearer_px);
    };
    const auto width = std::size_t(ldi.windows.width());
    const auto solid_in_row = [&](std::size_t row) {
        std::vector<std::uint64_t> solid;
        for (std::size_t p = row * width; p < (row + 1) * width; ++p)
            for (const std::uint64_t i : ldi.pixel(p)) {
                if (!(alpha_at(ldi, alpha, i) >= half_covered)) continue;
                const MergedSample s = sample_at(ldi, i);
                const Imath::V2d place(0.5 + double(s.dx), 0.5 + double(s.dy));
                if (is_solid(s, Imath::V2d(ldi.windows.pixel(p)) + place)) solid.push_back(i);
                break; // only the first can be
            }
        return solid;
    };
    for (const std::uint64_t i : joined(std::size_t(ldi.windows.height()), solid_in_row)) {
        ldi.solid.resize(ldi.samples(), 0);
        ldi.solid[i] = float(thickness);
    }
}

} // namespace sparselens
