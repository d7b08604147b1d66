#include "dof/footprints/footprint.h"

#include "dof/tuning.h"
#include "kernels/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

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

namespace {

constexpr float within = GatherTuning::joined_px;

// The range of a value over some samples.
struct Extent {
    float least, most;
    bool is_narrow() const { return most - least <= within; }
    Extent with(const Extent &other) const {
        return {std::min(least, other.least), std::max(most, other.most)};
    }
};

// Footprints that are being joined: the range of positions and of CoCs of each edge.
struct Joining {
    std::array<Extent, 4> place, coc;
    Extent depth;
    std::uint32_t sample;

    // Joins it with `next`, which follows on the right (axis 0) or below (1), if the edges go on straight.
    std::optional<Joining> with(const Joining &next, std::size_t axis) const;
    JoinedFootprint done() const;
};

std::optional<Joining> Joining::with(const Joining &next, std::size_t axis) const {
    const std::size_t begin = 2 * axis, end = begin + 1;
    if (!place[end].with(next.place[begin]).is_narrow() || !coc[end].with(next.coc[begin]).is_narrow())
        return {};
    Joining both = *this;
    both.depth = depth.with(next.depth);
    both.place[end] = next.place[end], both.coc[end] = next.coc[end];
    for (const std::size_t edge : {2 - begin, 3 - begin}) {
        both.place[edge] = place[edge].with(next.place[edge]);
        both.coc[edge] = coc[edge].with(next.coc[edge]);
        if (!both.place[edge].is_narrow() || !both.coc[edge].is_narrow()) return {};
    }
    return both.depth.is_narrow() ? std::optional(both) : std::nullopt;
}

// The result is wide enough for all parts: within the lamp's disc, an edge whose CoC is off by some pixels is off by at
// most as many pixels.
JoinedFootprint Joining::done() const {
    JoinedFootprint joined{{}, depth.least, depth.most, sample};
    for (std::size_t k = 0; k < 4; ++k) {
        const float off = (coc[k].most - coc[k].least) / 2;
        joined.footprint.place[k] = k % 2 == 0 ? place[k].least - off : place[k].most + off;
        joined.footprint.coc[k] = coc[k].least + off;
    }
    return joined;
}

// Joins each part to the last one before it that it continues.
std::vector<Joining> joined_along(std::size_t axis, std::span<const Joining> parts) {
    std::vector<Joining> all;
    for (const Joining &part : parts) {
        const auto goes_on = [&](Joining &one) {
            const std::optional<Joining> both = one.with(part, axis);
            if (both) one = *both;
            return both.has_value();
        };
        if (std::none_of(all.rbegin(), all.rend(), goes_on)) all.push_back(part);
    }
    return all;
}

Joining alone(const SamplesInPicture &samples, std::uint32_t sample, const Footprint &footprint) {
    Joining one{{}, {}, {samples.depth(sample), samples.depth(sample)}, sample};
    for (std::size_t k = 0; k < 4; ++k) {
        one.place[k] = {footprint.place[k], footprint.place[k]};
        one.coc[k] = {footprint.coc[k], footprint.coc[k]};
    }
    return one;
}

} // namespace

std::vector<JoinedFootprint> joined(const SamplesInPicture &samples, const SampleRun &run,
                                    std::uint32_t opaque_end, std::span<const Footprint> footprints) {
    std::vector<Joining> opaque;
    for (std::uint32_t i = run.begin; i < opaque_end; ++i)
        opaque.push_back(alone(samples, i, footprints[i - run.begin]));
    std::vector<JoinedFootprint> all;
    for (const Joining &one : joined_along(1, joined_along(0, opaque))) all.push_back(one.done());
    for (std::uint32_t i = opaque_end; i < run.end; ++i)
        all.push_back({footprints[i - run.begin], samples.depth(i), samples.depth(i), i});
    return all;
}

} // namespace sparselens
