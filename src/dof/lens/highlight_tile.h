// The light of highlights (highlights.h) in one tile: the exact disc of each lamp, less what is hidden by things in
// front of the lamp (highlight_shadows.h).
//
// A disc of a few pixels is shadowed in cells of the lens (lens/lamp_shadow.h), a larger one in pixels. If the CoC of a
// sample is two pixels or more, its light comes from its position. Near the focus its light comes from the square of a
// pixel, as lens points see it, so that what is in focus stays as it was rendered. In between, the square shrinks.
#pragma once

#include "dof/lens/gather_scene.h"
#include "dof/lens/highlight_shadows.h"
#include "dof/lens/lens_gather.h"
#include "lens/lamp_shadow.h"
#include "lens/lamp_spread.h"

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

class HighlightTile {
public:
    // `casters`: of the scene.
    HighlightTile(const GatherScene &scene, const CasterSets &casters);

    // Spreads highlights over the tile whose first pixel is `origin`, relative to the data window's corner like the
    // samples. `blocks`: those that can reach it. `coarse`: given if the tile is gathered in cells.
    void spread(const Imath::V2i &origin, std::span<const std::uint32_t> blocks,
                const CoarseCasters *coarse = nullptr);

    // The light at a pixel of the tile. dark(): no light reaches it.
    float value(int x, int y, std::size_t channel) const { return light_[at(x, y, channel)]; }
    bool dark(int x, int y) const;

private:
    static constexpr int size = lens_tile_size;
    static std::size_t at(int x, int y, std::size_t channel) {
        return (channel / 4 * size * size + std::size_t(y * size + x)) * 4 + channel % 4;
    }

    struct Spreading { // the current highlight
        std::uint32_t highlight, sample;
        Lamp lamp; // relative to the tile
        bool shadowed = false;
        bool together = false;          // it shares all its shadows with others of its group
        const LampLight *few = nullptr; // for a disc of few pixels, if anything hides a part of it
    };
    Lamp lamp(std::uint32_t highlight) const;
    Imath::Box2i reach_of(const Lamp &lamp);
    void spread_group(std::span<const std::uint32_t> group);
    void spread_one(std::uint32_t highlight);
    void spread_small(const LampLight &light, const Spreading &from);
    void spread_disc(const Spreading &from);
    void add_whole(const Spreading &from, double weight);
    void spread_shape(const Spreading &from);
    void add_seen(const Spreading &from, int x, int y, double weight, const std::array<double, 3> *colours);
    // `disc`: the disc that the light lies in. In a pixel that its edge crosses, only the part inside is lit.
    void add(const Spreading &from, int x, int y, unsigned of, double weight, const LampDisc *disc = nullptr);
    bool waits(const Spreading &from, int x, int y, const LampDisc *disc) const;
    void add_row(const Spreading &from, int y, int begin, int end, const double *weights);
    float lit(const Spreading &from, int x, int y, const LampDisc *disc) const;
    void add_group();
    void add_lit();
    const LampCells &cells_of(const Lamp &lamp);
    double left_by_cat_eye(bool behind, int x, int y, std::size_t colour);

    const GatherScene &scene_;
    const Highlights &highlights_ = scene_.highlights;
    const Aperture &aperture_ = scene_.optics->aperture;
    const CatEye &cat_eye_ = scene_.optics->cat_eye;
    const HoldoutLookup &held_out_ = scene_.held_out;
    const std::vector<ColourSet> &sets_ = scene_.colours.sets;
    HighlightShadows shadows_;
    Imath::V2d half_extent_; // of the aperture, for each pixel of CoC
    Imath::V2i origin_;
    // pixels of the tile that the current highlights reach
    Imath::Box2i reached_;
    std::array<std::optional<LampCells>, 2> cells_; // [behind], made when first asked for
    std::array<std::vector<double>, 6>
        left_by_cat_eye_;      // [colour][behind][pixel], computed when first asked for
    std::vector<float> light_; // [group][row][column][4]
    // The same, for the current highlights that are shadowed together, as if nothing hid them.
    std::vector<float> together_;
    bool any_together_ = false;
    // [group][4]: what each pixel gets from discs that cover the whole tile; the second, from the current highlights.
    std::vector<float> whole_, whole_together_;
};

} // namespace sparselens
