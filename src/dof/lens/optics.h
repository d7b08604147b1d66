// The lens with its looks: an aperture, a plane of focus that may be bent, a picture that may be magnified or darkened.
#pragma once

#include "base/image.h"
#include "dof/lens/sample_blocks.h"
#include "dof/lens/sample_colours.h"
#include "lens/cat_eye.h"
#include "lens/focus_field.h"
#include "lens/lens_looks.h"
#include "lens/lens_samples.h"

#include <span>
#include <vector>

namespace sparselens {

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
        return left_.empty() || !is_colour(sets_[channel]) ? 1 : left_[windows_.index(x, y)];
    }
    void darken(Image &image) const; // which must have these windows

private:
    Windows windows_;
    std::vector<ColourSet> sets_;
    std::vector<float> left_; // [pixel]: the share that is left; empty: all
};

} // namespace sparselens
