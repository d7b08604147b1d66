#include "dof/footprints/footprint.h"

#include "dof/tuning.h"
#include "kernels/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {

namespace {

constexpr float whole = GatherTuning::footprint_whole_px;
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
const std::array<Imath::V2i, 4> beside{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

// Finds the samples of a box of pixels among `samples`.
class Neighbourhood {
public:
    Neighbourhood(const Ldi &ldi, const SamplesInPicture &samples, const Imath::Box2i &box,
                  std::span<const SampleRun> runs)
        : ldi_(ldi), samples_(samples), box_(box) {
        for (int y = box.min.y; y <= box.max.y; ++y) {
            const std::uint64_t first = ldi.begin[pixel(box.min.x, y)];
            rows_.push_back(
                {first, std::vector<std::uint32_t>(ldi.begin[pixel(box.max.x, y) + 1] - first, none)});
        }
        for (const SampleRun &run : runs)
            for (std::uint32_t i = run.begin; i < run.end; ++i) put(i);
    }

    // Returns the index in `samples` of the LDI's sample i, which a pixel of row y has.
    std::uint32_t place(int y, std::uint64_t i) const {
        const Row &row = rows_[std::size_t(y - box_.min.y)];
        return row.place[i - row.first];
    }

    // Returns the sample in the pixel one step on that is linked to sample `of` of pixel `at`; both are indices in
    // `samples`.
    std::uint32_t linked(const Imath::V2i &at, const Imath::V2i &step, std::uint32_t of) const {
        const std::uint32_t source = samples_.source[of];
        if (!samples_.links || source >= ldi_.samples()) return none;
        const LinkedSample found = samples_.links->linked(samples_.links->opaque(source), at, step);
        return found.found() && box_.intersects(at + step) ? place(at.y + step.y, found.sample) : none;
    }

    // Returns the sample of pixel (x, y) that is one surface with sample `of`; both are indices in `samples`.
    std::uint32_t neighbour(int x, int y, std::uint32_t of) const {
        if (!box_.intersects(Imath::V2i(x, y))) return none;
        std::uint32_t found = none;
        float least = torn_px;
        for (std::uint64_t i = ldi_.begin[pixel(x, y)]; i < ldi_.begin[pixel(x, y) + 1]; ++i) {
            const std::uint32_t n = place(y, i);
            const float apart = n == none ? least : std::abs(samples_.depth(n) - samples_.depth(of));
            if (apart >= least) continue;
            found = n;
            least = apart;
        }
        return found;
    }

private:
    struct Row { // a row of pixels, whose samples follow each other in the LDI
        std::uint64_t first;
        std::vector<std::uint32_t> place;
    };
    std::size_t pixel(int x, int y) const {
        return std::size_t(y) * std::size_t(ldi_.windows.width()) + std::size_t(x);
    }
    void put(std::uint32_t i) {
        const std::uint32_t source = samples_.source[i];
        for (Row &row : rows_)
            if (source >= row.first && source - row.first < row.place.size())
                row.place[source - row.first] = i;
    }

    const Ldi &ldi_;
    const SamplesInPicture &samples_;
    Imath::Box2i box_;
    std::vector<Row> rows_;
};

Footprint unit_square(const SamplesInPicture &samples, std::uint32_t at) {
    const float x = samples.x[at], y = samples.y[at], c = samples.coc[at];
    return {{x - 0.5f, x + 0.5f, y - 0.5f, y + 0.5f}, {c, c, c, c}};
}

Footprint footprint(const SamplesInPicture &samples, const Neighbourhood &near, int x, int y,
                    std::uint32_t own) {
    Footprint f = unit_square(samples, own);
    for (std::size_t k = 0; k < 4; ++k) {
        std::uint32_t n = near.neighbour(x + beside[k].x, y + beside[k].y, own);
        const float apart = n == none ? torn_px : std::abs(samples.depth(own) - samples.depth(n));
        float joined = std::min((torn_px - apart) / (torn_px - whole), 1.0f);
        if (joined < 1)
            if (const std::uint32_t steep = near.linked({x, y}, beside[k], own); steep != none) {
                n = steep;
                joined = 1;
            }
        if (n == none) continue;
        const std::span<const float> place = k < 2 ? samples.x : samples.y;
        // Rounded to 1024ths, so that rounding is the same everywhere in the picture.
        const auto shared = [&](float alone, float a, float b) {
            const float middle = (a + b) / 2;
            return joined == 1 ? middle : alone + std::round(joined * (middle - alone) * 1024) / 1024;
        };
        f.place[k] = shared(f.place[k], place[own], place[n]);
        f.coc[k] = shared(f.coc[k], samples.coc[own], samples.coc[n]);
    }
    return f;
}

} // namespace

std::vector<Footprint> footprints_of(const Ldi &ldi, const SamplesInPicture &samples,
                                     const Imath::Box2i &pixels, const SampleRun &run,
                                     std::span<const SampleRun> around) {
    const Imath::Box2i all({0, 0}, {ldi.windows.width() - 1, ldi.windows.height() - 1});
    const Imath::V2i least = pixels.min - Imath::V2i(1), most = pixels.max + Imath::V2i(1);
    const Neighbourhood near(ldi, samples,
                             {{std::max(least.x, all.min.x), std::max(least.y, all.min.y)},
                              {std::min(most.x, all.max.x), std::min(most.y, all.max.y)}},
                             around);
    std::vector<Footprint> footprints;
    for (std::uint32_t i = run.begin; i < run.end; ++i) footprints.push_back(unit_square(samples, i));
    for (int y = pixels.min.y; y <= std::min(pixels.max.y, all.max.y); ++y)
        for (int x = pixels.min.x; x <= std::min(pixels.max.x, all.max.x); ++x) {
            const Imath::V2i at = ldi.windows.data.min + Imath::V2i(x, y);
            for (const std::uint64_t i : ldi.pixel(ldi.windows.index(at.x, at.y))) {
                const std::uint32_t own = near.place(y, i);
                if (own != none) footprints[own - run.begin] = footprint(samples, near, x, y, own);
            }
        }
    return footprints;
}

float coc_to_edges(const Links *links, const Imath::Box2i &pixels) {
    float largest = torn_px / 2;
    if (!links) return largest;
    float least = INFINITY, most = -INFINITY;
    const auto for_all = [&](int around, const auto &visit) {
        for (int y = pixels.min.y - around; y <= pixels.max.y + around; ++y)
            for (int x = pixels.min.x - around; x <= pixels.max.x + around; ++x)
                links->for_each_opaque({x, y}, [&](const LinkedSample &s) { visit(Imath::V2i(x, y), s); });
    };
    for_all(1, [&](const Imath::V2i &, const LinkedSample &s) {
        least = std::min(least, s.depth);
        most = std::max(most, s.depth);
    });
    if (!(most - least > torn_px)) return largest;
    for_all(0, [&](const Imath::V2i &at, const LinkedSample &s) {
        for (const Imath::V2i &step : beside) {
            const LinkedSample next = links->linked(s, at, step);
            if (next.found()) largest = std::max(largest, std::abs(next.depth - s.depth) / 2);
        }
    });
    return largest;
}

} // namespace sparselens
