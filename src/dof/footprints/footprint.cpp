#include "dof/footprints/footprint.h"

#include "dof/tuning.h"
#include "kernels/surface.h"

#include <algorithm>
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
    Neighbourhood(const Ldi &ldi, const SamplesInPicture &samples, const PositionBox &box,
                  std::span<const SampleRun> runs)
        : ldi_(ldi), samples_(samples), box_(box) {
        for (int y = box.min.row; y <= box.max.row; ++y) {
            const std::uint64_t first = ldi.begin[ldi.windows.index(Position(box.min.column, y))],
                                end = ldi.begin[ldi.windows.index(Position(box.max.column, y)) + 1];
            rows_.push_back({first, std::vector<std::uint32_t>(end - first, none)});
        }
        for (const SampleRun &run : runs)
            for (std::uint32_t i = run.begin; i < run.end; ++i) put(i);
    }

    // Returns the index in `samples` of the LDI's sample i, which a pixel of row y has.
    std::uint32_t place(int y, std::uint64_t i) const {
        const Row &row = rows_[std::size_t(y - box_.min.row)];
        return row.place[i - row.first];
    }

    // Returns the sample in the pixel one step on that is linked to sample `of` of pixel `at`; both are indices in
    // `samples`.
    std::uint32_t linked(const Position &at, const Imath::V2i &step, std::uint32_t of) const {
        const std::uint32_t source = samples_.source[of];
        if (!samples_.links || source >= ldi_.samples()) return none;
        const LinkedSample found = samples_.links->linked(samples_.links->opaque(source), at, step);
        return found.found() && box_.contains(at + step) ? place(at.row + step.y, found.sample) : none;
    }

    // Returns the sample of pixel `at` that is one surface with sample `of`; both are indices in `samples`.
    std::uint32_t neighbour(const Position &at, std::uint32_t of) const {
        if (!box_.contains(at)) return none;
        std::uint32_t found = none;
        float least = torn_px;
        for (const std::uint64_t i : ldi_.pixel(ldi_.windows.index(at))) {
            const std::uint32_t n = place(at.row, i);
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
    void put(std::uint32_t i) {
        const std::uint32_t source = samples_.source[i];
        for (Row &row : rows_)
            if (source >= row.first && source - row.first < row.place.size())
                row.place[source - row.first] = i;
    }

    const Ldi &ldi_;
    const SamplesInPicture &samples_;
    PositionBox box_;
    std::vector<Row> rows_;
};

Footprint unit_square(const SamplesInPicture &samples, std::uint32_t at) {
    const float x = samples.x[at], y = samples.y[at], c = samples.coc[at];
    return {{x - 0.5f, x + 0.5f, y - 0.5f, y + 0.5f}, {c, c, c, c}};
}

Footprint footprint(const SamplesInPicture &samples, const Neighbourhood &near, const Position &at,
                    std::uint32_t own) {
    Footprint f = unit_square(samples, own);
    for (std::size_t k = 0; k < 4; ++k) {
        std::uint32_t n = near.neighbour(at + beside[k], own);
        const float apart = n == none ? torn_px : std::abs(samples.depth(own) - samples.depth(n));
        float joined = std::min((torn_px - apart) / (torn_px - whole), 1.0f);
        if (joined < 1)
            if (const std::uint32_t steep = near.linked(at, beside[k], own); steep != none) {
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
                                     const PositionBox &pixels, const SampleRun &run,
                                     std::span<const SampleRun> around) {
    const Position last = ldi.windows.grid().array().box().max;
    const auto there = [&](int column, int row) {
        return Position(std::clamp(column, 0, last.column), std::clamp(row, 0, last.row));
    };
    const Position end = there(pixels.max.column, pixels.max.row);
    const Neighbourhood near(
        ldi, samples,
        {there(pixels.min.column - 1, pixels.min.row - 1), there(pixels.max.column + 1, pixels.max.row + 1)},
        around);
    std::vector<Footprint> footprints;
    for (std::uint32_t i = run.begin; i < run.end; ++i) footprints.push_back(unit_square(samples, i));
    for (int y = pixels.min.row; y <= end.row; ++y)
        for (int x = pixels.min.column; x <= end.column; ++x) {
            const Position at(x, y);
            for (const std::uint64_t i : ldi.pixel(ldi.windows.index(at))) {
                const std::uint32_t own = near.place(y, i);
                if (own != none) footprints[own - run.begin] = footprint(samples, near, at, own);
            }
        }
    return footprints;
}

float coc_to_edges(const Links *links, const PositionBox &pixels) {
    float largest = torn_px / 2;
    if (!links) return largest;
    float least = INFINITY, most = -INFINITY;
    const auto for_all = [&](int around, const auto &visit) {
        for (int y = pixels.min.row - around; y <= pixels.max.row + around; ++y)
            for (int x = pixels.min.column - around; x <= pixels.max.column + around; ++x) {
                const Position at(x, y);
                links->for_each_opaque(at, [&](const LinkedSample &s) { visit(at, s); });
            }
    };
    for_all(1, [&](const Position &, const LinkedSample &s) {
        least = std::min(least, s.depth);
        most = std::max(most, s.depth);
    });
    if (!(most - least > torn_px)) return largest;
    for_all(0, [&](const Position &at, const LinkedSample &s) {
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
