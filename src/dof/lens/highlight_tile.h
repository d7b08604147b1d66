// The light of highlights (highlights.h) in one tile: the exact disc of each, less what stands before the lamp.
//
// Whether a place in a disc sees the lamp needs no lens points of the gather: place and lamp fix the point of the lens, and
// so what hides the lamp there (lens/lamps/lamp_shadow.h). A sample hides what is farther by more than one_surface_px of
// perceptive depth. Highlights of partial coverage hide none of each other: they are lamps smaller than a pixel, side by
// side.
#pragma once

#include "dof/lens/block_footprints.h"
#include "dof/lens/highlights.h"
#include "dof/lens/lens_tile.h"
#include "dof/lens/sample_blocks.h"
#include "dof/lens/sample_colours.h"
#include "lens/aperture.h"
#include "lens/cat_eye.h"
#include "lens/lamp_spread.h"
#include "lens/lamps/lamp_shadow.h"

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// What shapes their light.
struct HighlightShape {
    const Aperture &aperture;
    const CatEye &cat_eye;
    double pixel_aspect = 1;
};

class HighlightTile {
public:
    HighlightTile(const Highlights &highlights, const BlockedSamples &samples,
                  const BlockFootprints &footprints, std::span<const ColourSet> sets,
                  const HighlightShape &shape, const HeldOut &held_out);

    // Of the tile whose first pixel is `origin`, relative to the data window's corner like the samples. `blocks`: those that
    // can reach it.
    void spread(const Imath::V2i &origin, std::span<const std::uint32_t> blocks);

    // At a pixel of the tile. `dark`: none reaches it.
    float value(int x, int y, std::size_t channel) const { return light_[at(x, y, channel)]; }
    bool dark(int x, int y) const;

private:
    static constexpr int size = LensTile::size;
    static std::size_t at(int x, int y, std::size_t channel) {
        return (channel / 4 * size * size + std::size_t(y * size + x)) * 4 + channel % 4;
    }

    struct Spreading { // the highlight at work
        std::uint32_t highlight, sample;
        Lamp lamp; // relative to the tile
        bool shadowed;
    };

    bool reaches(const Lamp &lamp) const;
    void spread_disc(const Spreading &from);
    void spread_shape(const Spreading &from);
    void add(const Spreading &from, int x, int y, unsigned of, double weight);
    bool cast_shadows(std::uint32_t lamp_sample, const Lamp &lamp, std::span<const std::uint32_t> blocks);
    template <typename Bounds>
    bool can_shadow(const Bounds &bounds, const Lamp &lamp) const;
    void cast_shadow(std::uint32_t sample, const Footprint &footprint, std::uint32_t name, const Lamp &lamp);
    double left_by_cat_eye(bool behind, int x, int y);

    const Highlights &highlights_;
    const BlockedSamples &samples_;
    const BlockFootprints &footprints_;
    std::vector<ColourSet> sets_;
    HighlightShape shape_;
    HeldOut held_out_;
    Imath::V2d half_extent_; // of the aperture, for each pixel of CoC
    Imath::V2i origin_;
    Imath::Box2i reached_; // pixels of the tile, by the highlight at work
    LampShadow shadow_;
    std::array<std::vector<double>, 2> left_by_cat_eye_; // [behind][pixel], computed when first asked for
    std::vector<float> light_;                           // [group][row][column][4]
};

} // namespace sparselens
