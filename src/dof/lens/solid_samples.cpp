#include "dof/lens/solid_samples.h"

#include "base/parallel.h"
#include "deep/build.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace sparselens {

namespace {

// The sample that shows where a solid is seen.
struct Shown {
    std::size_t pixel;
    std::uint64_t sample;
};

class Solids {
public:
    Solids(const Ldi &ldi, const ThinLens &lens) : ldi_(ldi), lens_(lens), alpha_(ldi.alpha()) {}

    // Calls visit(sample, what shows) for the solids of a pixel.
    template <typename Visit>
    void for_each(std::size_t pixel, const Visit &visit) const {
        for (const std::uint64_t i : ldi_.pixel(pixel))
            if (hides_from(i) > 0)
                if (const auto shown = shown_of(pixel, i)) visit(i, *shown);
    }
    PlacedSample placed(int x, int y, std::uint64_t i) const {
        const MergedSample s = sample_at(ldi_, i);
        return {float(x) + 0.5f + s.dx,
                float(y) + 0.5f + s.dy,
                float(circle_of_confusion(lens_, 1 / (1 / double(s.z) - double(s.solid)))),
                float(perceptive_depth(lens_, 1 / hides_from(i))),
                1,
                std::uint32_t(i)};
    }
    // The pixel that has a sample.
    std::size_t pixel_of(std::uint64_t i) const {
        return std::size_t(std::ranges::upper_bound(ldi_.begin, i) - ldi_.begin.begin() - 1);
    }
    // The Shown of a solid.
    Shown shown_by(std::uint64_t i) const { return *shown_of(pixel_of(i), i); }

private:
    // Samples with a smaller 1 / z are hidden; 0: none are.
    double hides_from(std::uint64_t i) const {
        return std::max(1 / double(ldi_.z[i]) - 2 * double(ldi_.solid[i]), 0.0) * (ldi_.solid[i] > 0);
    }
    bool may_show(std::uint64_t i) const {
        return is_opaque(alpha_at(ldi_, alpha_, i)) && (ldi_.optical.empty() || ldi_.optical[i] == ldi_.z[i]);
    }
    std::optional<Shown> shown_of(std::size_t pixel, std::uint64_t i) const {
        if (may_show(i)) return Shown{pixel, i};
        if (is_opaque(alpha_at(ldi_, alpha_, i))) return {};
        const Imath::V2i at = ldi_.windows.pixel(pixel);
        std::optional<Shown> nearest;
        double least = std::numeric_limits<double>::infinity();
        for (int y = at.y - 1; y <= at.y + 1; ++y)
            for (int x = at.x - 1; x <= at.x + 1; ++x) {
                if (!ldi_.windows.data.intersects(Imath::V2i(x, y))) continue;
                const std::size_t beside = ldi_.windows.index(x, y);
                for (const std::uint64_t n : ldi_.pixel(beside)) {
                    const double behind = 1 / double(ldi_.z[i]) - 1 / double(ldi_.z[n]);
                    if (!may_show(n) || behind > double(ldi_.solid[i]) || std::abs(behind) >= least) continue;
                    nearest = Shown{beside, n};
                    least = std::abs(behind);
                }
            }
        return nearest;
    }

    const Ldi &ldi_;
    const ThinLens &lens_;
    std::size_t alpha_;
};

} // namespace

BlockedSamples place_solids(const Ldi &ldi, const ThinLens &lens, const BlockedSamples &samples) {
    if (ldi.solid.empty()) return {};
    const Solids solids(ldi, lens);
    const auto in_pixel = [&](int x, int y, const auto &visit) {
        const Imath::V2i at = ldi.windows.data.min + Imath::V2i(x, y);
        solids.for_each(ldi.windows.index(at.x, at.y), visit);
    };
    const auto count = [&](int x, int y) {
        SampleCounts counts;
        in_pixel(x, y, [&](std::uint64_t, const Shown &) { counts.all = ++counts.opaque; });
        return counts;
    };
    const auto place = [&](int x, int y, std::vector<PlacedSample> &placed) {
        in_pixel(x, y, [&](std::uint64_t i, const Shown &) { placed.push_back(solids.placed(x, y, i)); });
    };
    BlockedSamples placed = make_blocks(ldi.windows, count, place);
    placed.named.resize(placed.count());
    parallel_ranges(placed.count(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            const Shown shown = solids.shown_by(placed.source[n]);
            placed.named[n] = place_of(samples, ldi, shown.pixel, shown.sample);
        }
    });
    return placed;
}

} // namespace sparselens
