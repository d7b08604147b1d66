// The data that the lens gather prepares from an LDI, for one lens and its looks, before the first tile. All tiles are
// gathered from it, on the CPU and on a device.
#pragma once

#include "base/image.h"
#include "deep/merge.h"
#include "dof/facets/placed_facets.h"
#include "dof/lens/fillers.h"
#include "dof/lens/highlights.h"
#include "dof/lens/lens_gather.h"
#include "dof/lens/sample_blocks.h"
#include "lens/cat_eye.h"
#include "lens/focus_field.h"
#include "lens/lens_looks.h"
#include "lens/lens_samples.h"

#include <Imath/ImathVec.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace sparselens {

// The lens with its looks: an aperture, a plane of focus that may be bent, a picture that may be magnified or darkened.
struct Optics {
    LensLooks looks;
    double coc;        // pixels, added to the CoC of all samples
    Imath::V2i corner; // of the data window
    Aperture aperture;
    PictureFrame frame;
    FocusField field;
    CatEye cat_eye;

    Optics(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks, double coc);

    // How many times the number of a tile's lens points is doubled, so that pixels see as many of them past a cat-eye
    // as of a whole lens. `first`, `size`: as in coc_gradient().
    std::size_t doubled(const Imath::V2i &first, int size) const;
    bool moves() const { return field.moves(); }
    // How far the aperture reaches along the axis where it reaches farthest, and where it reaches least, in pixels of
    // that axis per pixel of CoC.
    float widest() const, narrowest() const;

    // Bends the CoC of samples and moves the samples to where the magnified picture shows them. Their positions are
    // relative to the corner.
    void bend(BlockedSamples &samples) const;
    // How the CoC changes across a tile of `size` pixels whose first pixel is `first` (EXR coordinates), and the
    // largest displacement there, pixels.
    Imath::V2d coc_gradient(const Imath::V2i &first, int size) const;
    double displaced(const Imath::V2i &first, int size) const;
    // The lens points of that tile for a bent plane of focus, by the field at the tile's middle.
    std::vector<LensSample> bent(std::span<const LensSample> points, const Imath::V2i &first, int size) const;

    // FocusField::skew() of what the magnified picture shows at p.
    Imath::V2d skew(const Imath::V2d &p) const;
};

// How much of its colours a pixel keeps where a cat-eye darkens.
class Darkening {
public:
    Darkening(const CatEye &cat_eye, const Ldi &ldi, const Windows &windows);

    float left(std::size_t channel, int x, int y) const { // EXR coordinates
        return left_.empty() || !is_colour(sets_[channel]) ? 1 : left_[windows_.index(Imath::V2i(x, y))];
    }
    void darken(Image &image) const; // which must have these windows

private:
    Windows windows_;
    std::vector<ColourSet> sets_;
    std::vector<float> left_; // [pixel]: the share that is left; empty: all
};

struct HoldoutLookup {
    const Holdout *by = nullptr;
    double depth_at_1 = 1;   // disparity at z = 1
    Imath::V2i corner{0, 0}; // of the data window that the samples are relative to, EXR coordinates

    // Returns the share of light from a disparity that passes the holdout at a pixel, which is relative to
    // `corner`. `by` must be set.
    float passes(const Imath::V2i &pixel, float depth) const {
        const double z = depth > 0 ? depth_at_1 / double(depth) : std::numeric_limits<double>::infinity();
        return float(by->passes(corner.x + pixel.x, corner.y + pixel.y, z));
    }
};

struct GatherScene {
    const Ldi *ldi;    // must outlive this
    KnownPixels known; // of its pixels
    ThinLens lens;
    std::unique_ptr<const Optics> optics; // on the heap, because its parts refer to each other
    HoldoutLookup held_out;               // what stays sharp
    BlockedSamples samples;
    SampleColours colours; // without what highlights spread; empty if nothing is out of focus
    Highlights highlights;
    FillerSamples fillers;
    PlacedFacets facets;
    BlockedSamples solids = {};             // place_solids()
    std::unique_ptr<const Ldi> coarse = {}; // of a coarse scene: its LDI, with values of A alone

    // The cat-eye if pixels see through only some lens points, else null.
    const CatEye *cat_eye() const { return optics->cat_eye.cuts() ? &optics->cat_eye : nullptr; }
    double pixel_aspect() const { return lens.pixel_aspect; }
};

// `coc` is added to the CoC of all samples. Of the options, it uses the looks, the lens point, the holdout, and which
// pixels are known and were seen. `progress` may end the work between its steps.
GatherScene prepare(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                    const LensGatherOptions &options, double coc = 0, const Progress &progress = {});

// Adds the highlights of a picture to `lamps`. prepare() sharpens the colours first, so it may find slightly different
// ones.
void find_lamps(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                const LensGatherOptions &options, std::vector<LampPart> &lamps);

// Returns the scene at 1 / across of its size, for tiles so far out of focus that they are gathered in cells of
// `across` pixels, across and down (cells.h). It has no highlights, because their discs are exact, and nothing is
// sharpened. The scene must have no holdout.
GatherScene coarse_scene(const GatherScene &scene, int across);

// Calls visit(group) for the groups of moved highlights (highlights.h) whose light may reach a tile. Its first
// pixel is `origin`, relative to the data window's corner.
template <typename Visit>
void for_each_moved(const GatherScene &scene, const Imath::V2i &origin, const Visit &visit) {
    const Imath::V2d half = scene.optics->aperture.half_extent();
    Imath::Box2f pixels(Imath::V2f(origin), Imath::V2f(origin + Imath::V2i(lens_tile_size)));
    if (scene.optics->field.skews()) pixels.makeInfinite(); // light may reach farther
    scene.highlights.groups.for_each_moved(pixels, std::max(half.x, half.y * scene.pixel_aspect()), visit);
}

} // namespace sparselens
