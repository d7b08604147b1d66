#include "warp/solids.h"

#include "base/coverage.h"
#include "base/parallel.h"
#include "deep/build.h"
#include "lens/perceptive_depth.h"
#include "warp/tuning.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sparselens {

namespace {

// Pixels: how far a lens point moves a solid relative to its sample, plus the margin.
constexpr int reach = int(WarpTuning::solid_px) + WarpTuning::solid_margin;

// 1 / z of the farthest thing that a pixel shows; 0: it lets light through to infinity.
float farthest_in(const ViewSamples &view, std::size_t alpha, std::size_t pixel) {
    double left = 1;
    float farthest = 0;
    for (const std::uint64_t i : view.pixel(pixel)) {
        left *= 1 - double(alpha_at(view, alpha, i));
        farthest = 1 / view.z(i);
    }
    return lets_through(left) ? 0 : farthest;
}

// Returns the least value in a square around each pixel: along rows, then across them, a row at a time.
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

// The farthest depth in each pixel of a view.
std::vector<float> farthest_in(const ViewSamples &view) {
    std::vector<float> farthest(view.windows.pixels());
    const std::size_t alpha = view.alpha();
    parallel_ranges(farthest.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) farthest[p] = farthest_in(view, alpha, p);
    });
    return farthest;
}

// Looks up values of a view by position.
class Sight {
public:
    Sight(const ViewSamples &view, std::vector<float> values)
        : display_(view.windows.display), grid_(view.windows.data), values_(std::move(values)) {}

    // Returns nothing where the view does not look, and 0 where it has no pixel, because it shows nothing there.
    std::optional<float> at(const Imath::V2d &place) const {
        if (!(std::abs(place.x) < 1e9 && std::abs(place.y) < 1e9)) return {};
        const Imath::V2i pixel(int(std::floor(place.x)), int(std::floor(place.y)));
        if (grid_.contains(pixel.x, pixel.y)) return values_[grid_.index(pixel.x, pixel.y)];
        return display_.intersects(pixel) ? std::optional(0.0f) : std::nullopt;
    }

private:
    Imath::Box2i display_;
    Grid grid_;
    std::vector<float> values_;
};

// 1 / z of the farthest thing in a pixel and in those around it.
Sight farthest_around(const ViewSamples &view, const std::vector<float> &farthest) {
    return {view, least_around(farthest, Grid(view.windows.data), WarpTuning::solid_margin)};
}

// By how much the largest and the least 1 / z within reach differ.
Sight relief_around(const ViewSamples &view, std::vector<float> farthest) {
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
        const Sight sight = farthest_around(*view.samples, farthest_seen);
        if (&view == &views[0]) { // the centre view; few pixels are kept here
            const Sight relief = relief_around(*view.samples, std::move(farthest_seen));
            solid.keep([&](const MergedSample &s, const Imath::V2d &place) {
                return s.optical == s.z && back(s) > thickness &&
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

} // namespace sparselens
