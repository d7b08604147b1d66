// Small bright lights, spread exactly.
//
// A lamp far out of focus is a smooth disc. A sum over lens points gives such a disc only with more lens points than
// the disc has pixels. So the light of a sample that stands out far above its surroundings is taken out of the sample
// and spread by its point spread function (exact pixel areas) instead: highlight_tile.h. A lamp may have partial
// coverage; a lamp smaller than a pixel always has.
#pragma once

#include "base/grid.h"
#include "deep/build.h"
#include "dof/lens/sample_blocks.h"
#include "dof/tuning.h"
#include "shutter/lamp_paths.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

// Highlights that are shadowed together (highlight_shadows.h): samples of one surface and one block, within a square of
// a quarter of their CoC. A sample near the focus is alone.

// Where highlights are. A highlight is given by its index in `sample`.
struct PlacedHighlights {
    const BlockedSamples &samples;
    std::span<const std::uint32_t> sample; // of each highlight, ascending
    std::span<const Imath::V2f> moved;     // how far each is from its sample, pixels; empty: none is moved

    bool is_moved(std::uint32_t highlight) const {
        return !moved.empty() && moved[highlight] != Imath::V2f(0, 0);
    }
    Imath::V2f place(std::uint32_t highlight) const { // relative to the data window's corner
        const Imath::V2f at(samples.x[sample[highlight]], samples.y[sample[highlight]]);
        return moved.empty() ? at : at + moved[highlight];
    }
};

class HighlightGroups {
public:
    HighlightGroups() = default;
    // Each highlight is in one group.
    explicit HighlightGroups(const PlacedHighlights &highlights);

    // Calls visit(group) for the groups of a block that are not moved. A group lists the indices of its members in
    // `highlights`.
    template <typename Visit>
    void for_each(std::uint32_t block, const Visit &visit) const {
        for (std::uint32_t g = of_block_[block]; g < of_block_[block + 1]; ++g) visit(members(g));
    }
    // Calls visit(group) for the groups that are moved and whose light may reach these pixels. `extent`: of the
    // aperture, pixels per pixel of CoC.
    template <typename Visit>
    void for_each_moved(const Imath::Box2f &pixels, double extent, const Visit &visit) const {
        for (std::size_t n = 0; n < moved_.size(); ++n) {
            const Imath::V2f reach(float(double(moved_[n].coc) * extent) +
                                   GatherTuning::lamp_square_reach_px);
            if (pixels.intersects(Imath::Box2f(moved_[n].box.min - reach, moved_[n].box.max + reach)))
                visit(members(of_block_.back() + n));
        }
    }

private:
    struct Moved {
        Imath::Box2f box; // that the members lie in
        float coc = 0;    // the largest, without its sign
    };
    std::span<const std::uint32_t> members(std::size_t g) const {
        return std::span(members_).subspan(begin_[g], begin_[g + 1] - begin_[g]);
    }

    std::vector<std::uint32_t> members_;  // group after group
    std::vector<std::uint32_t> begin_;    // [group]: where its members begin; one entry more than groups
    std::vector<std::uint32_t> of_block_; // [block]: its first group; one entry more than blocks
    std::vector<Moved> moved_;            // the groups that follow those of the blocks
};

struct Highlights {
    std::vector<std::uint32_t> sample; // indices into the BlockedSamples, ascending; several may be the same
    std::vector<Imath::V2f> moved;     // how far the light is from its sample, pixels; empty: none is moved
    std::vector<float> share;          // share of its light that each spreads, (0, 1]
    SampleColours light;               // what each spreads; none in A
    HighlightGroups groups;            // of those samples

    PlacedHighlights among(const BlockedSamples &samples) const { return {samples, sample, moved}; }
};

// Finds the highlights of a picture, and takes the light that they spread out of `colours`. Four windows of 64 x 64
// pixels overlap at a sample. Four fifths of the samples of a window, counted by what they cover, stay below its level;
// the level at a sample is that of the darkest window. A sample is a highlight if the brightest of its channels
// (light_channels()) is more than four times this level. So at most a fifth are highlights, which bounds the cost.
// Volumes are no highlights and do not count. A window counts the samples in `seen` (pixels relative to the data
// window's corner) and beyond it only backgrounds, because all else there is made up; if it has none of these, it
// counts all its samples. A made-up sample must stand out of all samples of its windows, too, so that at
// most a fifth of these are highlights. From six times the level on, a sample spreads all light that stands out; below,
// less and less, so that nothing pops where a lamp is hardly one. A sample whose disc would be too wide and too faint
// to be seen (lamp_least_variance) is no highlight.
Highlights take_highlights(const Ldi &ldi, const BlockedSamples &samples, SampleColours &colours,
                           const std::optional<PositionBox> &seen = {});

// The highlights as parts of lamps. `corner`: of the data window, EXR coordinates.
std::vector<LampPart> lamp_parts(const Highlights &highlights, const BlockedSamples &samples,
                                 std::span<const std::size_t> brightness, const Imath::V2i &corner);

// Spreads the light of highlights that move along their paths: each becomes several highlights, whose discs overlap.
void spread_along(const LampPaths &paths, const BlockedSamples &samples, const Imath::V2i &corner,
                  Highlights &highlights);

// Which share of the samples around a sample is as bright as the sample.
//
// A lamp is rare: few lens points see it, so their mean is noisy. Something that covers a fifth or more of what they
// see is a bright surface, however dark its surroundings. Lens points see it well: n of them have a relative deviation
// of at most sqrt((1 / share - 1) / n).

// How much a sample counts among those around it: by what it covers, so that many thin layers do not outvote the
// surface behind them. Light without coverage counts wholly, and a volume not at all.
inline float counts_as(const Ldi &ldi, const BlockedSamples &samples, std::uint32_t sample) {
    const std::uint32_t source = samples.source[sample];
    if (source != BlockedSamples::background && is_volume(ldi, source)) return 0;
    return samples.alpha[sample] > 0 ? samples.alpha[sample] : 1;
}

class BrightShare {
public:
    static constexpr int cell = 4; // blocks wide and high, like the cells of their search

    BrightShare(const Ldi &ldi, const BlockedSamples &samples,
                const std::function<float(std::uint32_t sample)> &brightness);

    // Returns the share, [0, 1], of the samples within a cell's width of a sample, across and down, that are half as
    // bright or brighter. It changes continuously with brightness and position: samples from a quarter of the
    // brightness to all of it count in part.
    double around(std::uint32_t sample, float brightness) const;

private:
    static constexpr int octaves = 32; // of brightness, from 2^-16 on
    static int octave_of(float brightness);
    double count(int octave, const std::array<double, 4> &box) const;

    const BlockedSamples &samples_;
    ArrayGrid corners_; // of cells
    // [octave][corner]: what the samples to the left of the corner and above it count that are of this octave or
    // brighter
    std::vector<double> below_;
};

} // namespace sparselens
