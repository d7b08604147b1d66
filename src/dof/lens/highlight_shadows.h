// Finds what hides highlights (highlights.h) in one tile.
//
// Whether a position in a disc sees the lamp does not depend on the lens points of the gather: position and lamp
// determine the point of the lens, and so what hides the lamp there (lens/lamp_shadow.h). A sample hides everything
// farther; solids, and the fillers that hide lamps (fillers.h), do as samples do. But:
//
// - Samples of one surface do not shadow each other, because their footprints share edges; opaque samples side by side
//   cast one shadow (dof/footprints/footprint.h).
// - Highlights of partial coverage in other pixels that are at most a tenth nearer do not hide each other: they are
//   lamps smaller than a pixel, side by side.
// - A mirror does not hide the lamps that it shows (Ldi::image_z).
//
// The pixels of one lamp share the shadows that are nearly the same for all of them, so that a lamp of more pixels
// costs no more. On two pixels of a lamp that are w apart, the shadows of one caster are (1 - m) w apart in the
// picture, and m w apart relative to the discs, with m as in lamp_shadow.h. If one of these is at most a hundredth of
// the disc's radius, the members of a group (highlights.h) share the shadow on the member in their middle:
//
// - It stays in place if the caster is near the focus.
// - It moves with the disc, by whole pixels, if the caster is far in front of the lamp.
// - Other shadows are cast for each member.
//
// The samples of a coarse scene (cells.h) cast the shadows of what lies far in front of the lamp, where the shadow of a
// cell is at most this share of the disc's radius wide:
//
// - a sixteenth in a tile that is gathered in cells;
// - a sixteenth in a draft, else 1/64, in all tiles below final quality if wide lamps are many (tile_plan.h).
#pragma once

#include "dof/lens/highlights.h"
#include "dof/lens/sample_blocks.h"
#include "dof/lens/shadow_search.h"
#include "lens/lamp_shadow.h"
#include "lens/lamp_spread.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

class HighlightShadows {
public:
    // The first of the sets are the samples that Highlights::sample refers to.
    HighlightShadows(const Highlights &highlights, const CasterSets &sets)
        : highlights_(highlights), samples_(sets.front().samples), search_(sets) {}

    // Begins the tile whose first pixel is `origin`, relative to the data window's corner. `extent`: of the lens,
    // pixels per pixel of CoC. `coarse`: given if the tile is gathered in cells.
    void begin(const Imath::V2i &origin, double pixel_aspect, const Imath::V2d &extent,
               const CoarseCasters *coarse = nullptr);

    // Below, a highlight is given by its index in Highlights.
    // Finds the shadows that the members of a group share, in the pixels of a box. cast() adds the other shadows of
    // each member.
    void share(std::span<const std::uint32_t> group, const Imath::Box2i &box);

    // Casts the shadows on one member of the group, on a screen of that box. Returns false if nothing hides any part of
    // it.
    bool cast(std::uint32_t highlight, const ShadowScreen &screen);

    // Whether all of the box is hidden from the whole group.
    bool dark() const { return in_place_.dark() || in_disc_.dark(); }

    // As LampShadow::lit().
    float lit(int x, int y, const LampDisc *disc = nullptr) const;

    // Whether the member last given to cast() has no shadows but those that lie in one place for the whole group.
    bool only_shares() const { return in_place_.any && !own_.any; }
    float shared_lit(int x, int y) const { return in_place_.lamp.lit(x, y); }
    bool is_shared_crossed(int x, int y) const { return in_place_.lamp.is_crossed(x, y); }

    // The result of cast() for a group of one.
    const LampShadow &own() const { return own_.lamp; }

    Lamp lamp(std::uint32_t highlight) const; // relative to the tile

private:
    struct Shadow {
        LampShadow lamp;
        Imath::Box2i box; // of the pixels or cells that it is cast on
        bool any = false; // whether anything casts it

        void hide(const Imath::Box2f &rectangle, float alpha, std::uint32_t thing, bool fine) {
            begin(fine);
            lamp.hide(rectangle, alpha, thing);
        }
        void add(const Shadow &other, const Imath::V2i &moved) {
            begin(false);
            lamp.add(other.lamp, moved);
        }
        bool dark() const { return any && lamp.dark(); }

    private:
        void begin(bool fine) {
            if (!any) lamp.begin(box, fine);
            any = true;
        }
    };
    Imath::V2f place(std::uint32_t highlight) const; // relative to the data window's corner
    std::uint32_t middle_of(std::span<const std::uint32_t> group) const;
    Imath::V2i moved(std::uint32_t member) const;
    Shadow *shared_by_all(const ShadowEdges &edges);
    struct Caster {
        const ShadowCasters *of;
        const JoinedFootprint *joined; // its depth is in the pixels of these casters
        std::uint32_t name;
    };
    template <typename Visit>
    void for_each_caster(const ShadowedLamp &lamp, const CastingBlock &block,
                         const ShadowSearch::Range &range, const Visit &visit) const;
    const std::vector<JoinedFootprint> &casters_of(const ShadowedLamp &lamp, const CastingBlock &block) const;
    bool is_in_mirror_of(std::uint32_t lamp_sample, const Caster &caster) const;
    static bool casts_hardly(const ShadowedLamp &lamp, float hardly, const Caster &caster);
    static ShadowEdges edges_of(const ShadowedLamp &lamp, const Caster &caster);
    static bool may_cast(const ShadowedLamp &group, const Caster &caster, const ShadowEdges &edges);
    void cast_one(Shadow &into, const ShadowedLamp &lamp, const ShadowSearch::Range &range,
                  const Caster &caster, const ShadowEdges &edges) const;
    bool are_side_by_side(std::uint32_t lamp_sample, std::uint32_t sample) const;
    bool is_left_behind(std::uint32_t lamp_sample, const Caster &caster) const;

    const Highlights &highlights_;
    const BlockedSamples &samples_;
    ShadowSearch search_;
    Imath::V2i origin_;
    double pixel_aspect_ = 1;
    bool is_moved_ = false;             // whether the group is moved along a path
    std::optional<ShadowedLamp> group_; // set for a group of several samples
    std::vector<Caster> apart_;         // casters whose shadows differ between the members of the group
    Shadow in_place_, in_disc_;         // of the group; in_disc_ is that of its middle lamp
    Shadow own_;                        // of a member; has the group's too, unless they are all in place
};

} // namespace sparselens
