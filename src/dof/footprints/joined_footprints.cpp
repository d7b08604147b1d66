#include "dof/footprints/joined_footprints.h"

#include "dof/tuning.h"

#include <algorithm>
#include <array>
#include <optional>

namespace sparselens {

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
    for (const std::size_t beside : {2 - begin, 3 - begin}) {
        both.place[beside] = place[beside].with(next.place[beside]);
        both.coc[beside] = coc[beside].with(next.coc[beside]);
        if (!both.place[beside].is_narrow() || !both.coc[beside].is_narrow()) return {};
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
