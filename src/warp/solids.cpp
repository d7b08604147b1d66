#include "warp/solids.h"

#include "base/coverage.h"
#include "base/parallel.h"
#include "deep/build.h"
#include "lens/perceptive_depth.h"
#include "warp/sight.h"
#include "warp/tuning.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sparselens {

namespace {

// Pixels: how far a lens point moves a solid relative to its sample, plus the margin.
constexpr int reach = int(WarpTuning::solid_px) + WarpTuning::sight_margin;

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
