// What hides highlights (highlights.h) in one tile.
//
// Whether a place in a disc sees the lamp needs no lens points of the gather: place and lamp fix the point of the lens, and
// so what hides the lamp there (lens/lamp_shadow.h). A sample hides all that is farther; those of one surface hide
// none of each other, as they end where the next begins (dof/footprints/footprint.h). Opaque ones side by side cast one
// shadow (dof/footprints/joined_footprints.h). Highlights of partial coverage in other pixels, no more than a tenth nearer,
// hide none of each other: they are lamps smaller than a pixel, side by side.
//
// The pixels of one lamp share the shadows that are nearly the same for all of them, so that a lamp costs no more where it has
// more pixels. Of two places of a lamp, w pixels apart, the shadows of one thing lie (1 - m) w apart, m as in lamp_shadow.h.
// Where that is a fiftieth of the disc's radius at most, the members of a group (highlight_groups.h) take the shadow from the one in
// their middle. What stands nearer to the lamp is cast for each of them.
//
// In a tile that is gathered in cells (cells.h) the shadows of what stands far before the lamp are those of the coarse scene's samples:
// that of a cell is no wider than a sixteenth of the disc's radius.
#pragma once

#include "dof/lens/highlights.h"
#include "dof/lens/sample_blocks.h"
#include "dof/lens/shadow_lists.h"
#include "dof/lens/shadow_search.h"
#include "lens/lamp_shadow.h"
#include "lens/lamp_spread.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

class HighlightShadows {
public:
    // `samples`: those that highlights are named by. `solids` (solid_samples.h) cast shadows as well.
    HighlightShadows(const Highlights &highlights, const ShadowCasters &samples, const ShadowCasters &solids)
        : highlights_(highlights), samples_(samples.samples), search_(samples, solids) {}

    // Of the tile whose first pixel is `origin`, relative to the data window's corner. Then the blocks that can reach it.
    // `extent`: of the lens, for each pixel of CoC. `coarse`: for a tile that is gathered in cells. `lists`: of the tiles that are
    // gathered from the same scene.
    void begin(const Imath::V2i &origin, std::span<const std::uint32_t> samples,
               std::span<const std::uint32_t> solids, double pixel_aspect, const Imath::V2d &extent,
               const CoarseCasters *coarse = nullptr, const ShadowLists *lists = nullptr);

    // Highlights are named by their place in Highlights.
    // For a group: what its members share, in the pixels of a box. Only cast() for each tells the rest.
    void share(std::span<const std::uint32_t> group, const Imath::Box2i &box);

    // For one member of the group, on a screen of that box. False: nothing hides a part of it.
    bool cast(std::uint32_t highlight, const ShadowScreen &screen);

    // Whether all of the box is hidden from the whole group.
    bool dark() const { return shared_.dark(); }

    // As LampShadow::lit().
    float lit(int x, int y, const LampDisc *disc = nullptr) const;

    // For a member of the group of which cast() tells nothing: what is shared alone.
    bool only_shares() const { return shared_.any && !own_.any; }
    float shared_lit(int x, int y) const { return shared_.lamp.lit(x, y); }
    bool is_shared_crossed(int x, int y) const { return shared_.lamp.is_crossed(x, y); }

    // What cast() said, of a group of one.
    const LampShadow &own() const { return own_.lamp; }

    Lamp lamp(std::uint32_t highlight) const; // relative to the tile

private:
    struct Shadow {
        LampShadow lamp;
        bool any = false; // whether anything casts it

        void hide(const Imath::Box2f &rectangle, float alpha, std::uint32_t thing,
                  const ShadowScreen &screen) {
            if (!any) lamp.begin(screen.box, screen.fine);
            any = true;
            lamp.hide(rectangle, alpha, thing);
        }
        bool dark() const { return any && lamp.dark(); }
    };
    Imath::V2f place(std::uint32_t highlight) const; // relative to the data window's corner
    std::uint32_t middle_of(std::span<const std::uint32_t> group) const;
    template <typename Visit>
    void for_each_block(const ShadowedLamp &lamp, std::uint32_t first_member, const Visit &visit) const;
    std::vector<CastingBlock> blocks_of_disc(const ShadowedLamp &lamp) const;
    bool is_apart(const ShadowedLamp &group, const CastingBlock &block) const;
    struct Caster {
        const ShadowCasters *of;
        const JoinedFootprint *joined; // whose depth is as these casters count it
        std::uint32_t name;
    };
    template <typename Visit>
    void for_each_caster(const ShadowedLamp &lamp, const CastingBlock &block, const Visit &visit) const;
    const std::vector<JoinedFootprint> &casters_of(const ShadowedLamp &lamp, const CastingBlock &block) const;
    bool may_cast(const ShadowedLamp &group, const Caster &caster) const;
    void cast_one(const ShadowedLamp &lamp, const ShadowSearch::Range &range, const Caster &caster,
                  Shadow &into) const;
    bool are_side_by_side(std::uint32_t lamp_sample, std::uint32_t sample) const;

    const Highlights &highlights_;
    const BlockedSamples &samples_;
    ShadowSearch search_;
    const ShadowLists *lists_ = nullptr;
    Imath::V2i origin_;
    double pixel_aspect_ = 1;
    Imath::V2d extent_{1, 1};
    std::optional<ShadowedLamp> group_; // of several samples
    std::vector<Caster> apart_;         // of other shadows on each of its samples
    Shadow shared_, own_;
};

} // namespace sparselens
