// The splats that the gather and the scatter spread: each sample of an LDI as seen by one lens, and the background that
// shines through where a pixel's samples leave it uncovered.
#pragma once

#include "deep/ldi.h"
#include "kernels/layer_rules.h"
#include "lens/thin_lens.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

// How the fragments that cover one destination pixel become its colour: the rule that the selective gather
// and the scatter share.
//
// A fragment is the share of a splat that its PSF brings to the pixel: coverage, what is known of it (below) and
// premultiplied colours, times the PSF's weight. Fragments are binned by CoC, which at a given focus differs from
// disparity (R F / z) only by a sign and a constant. Bins that follow each other without a gap are one layer,
// and layers are blended in order of depth. The coverage of a layer is the sum of its fragments' coverages, and its
// colour is their mean.
//
// Some lens points of a pixel are unknown, because they look at something that no view saw. What is known at a layer is
// the sum of what is known in it (the coverage of an opaque sample; the light that any sample stops or passes on) and
// behind it (a lens point that sees something there is not covered here), including transparent background, but at most
// 1. The layer's share of the light that reaches it is its coverage divided by this sum. So unknown lens points are
// left out, and the others replace them at the depths where they are missing: what lies in front of a place that no
// view saw keeps its coverage.
//
// Near the picture's border the part of a PSF's disc that lies outside is unknown at all depths; sums are divided
// by the part that lies inside (window_share).

// Bins are numbered front to back. Their width is half a pixel of CoC where the blur is small and a fixed
// share of the CoC where it is large, so that their number stays bounded.
int depth_bin(double coc);

// The sums of one bin or layer, in this order: coverage, known, and the colours. A bin has one sum more: known times
// radius, for its mean radius.
inline constexpr std::size_t sums_before_colours = 2;

// The part of a disc of that radius around pixel (x, y) that lies in the data window.
double window_share(const Imath::Box2i &data, double pixel_aspect, int x, int y, double radius);

// Blends the layers of one pixel. `layers`: the sums of each layer, front to back. Sets the colours and returns alpha.
double blend_layers(std::span<const double> layers, std::span<double> colours);

// The layers of a tile's pixels, grown bin by bin from front to back; where a pixel has more than the limit, the
// two layers with the narrowest gap between them are merged.
class TileLayers {
public:
    TileLayers(std::size_t pixels, std::size_t limit, std::size_t colours);

    void clear();
    // Adds the sums of one bin at one pixel, which lie `stride` apart, multiplied by `scale`. Bins must come in
    // ascending order.
    void add(std::size_t pixel, int bin, const double *sums, std::size_t stride, double scale);
    double blend(std::size_t pixel, std::span<double> colours) const; // as blend_layers

private:
    struct State {
        std::size_t count = 0;
        int last_bin = 0;
    };
    double *layer(std::size_t pixel, std::size_t index) {
        return &sums_[(pixel * (limit_ + 1) + index) * size_];
    }
    int &gap(std::size_t pixel, std::size_t index) { return gaps_[pixel * (limit_ + 1) + index]; }
    void merge_closest(std::size_t pixel);

    std::size_t limit_, size_;
    std::vector<State> states_;
    std::vector<int> gaps_; // between a layer and the one in front of it, in bins
    std::vector<double> sums_;
};

// Samples of a pixel that fall into one layer hide each other here, in the pixel; samples of different layers
// are left to the blend.
struct Splat {
    Imath::V2d position; // EXR pixel coordinates, inside the pixel that owns the sample
    double coc = 0;      // signed, pixels
    int bin = 0;         // depth bin
    double coverage = 0; // alpha, less what the pixel's samples of the same layer hide; 0 for the background
    double known = 0;    // coverage, and what passes the pixel's layer if this is the last sample in it
    double scale = 0;    // what to multiply the sample's premultiplied colours by
    std::size_t sample = 0; // index in the LDI; npos: transparent background at infinity
};

class SplatSource {
public:
    SplatSource(const Ldi &ldi, const ThinLens &lens);

    // Calls visit(splat), front to back, for the splats of a pixel (row * width + column). Samples without coverage are
    // left out.
    template <typename Visit>
    void for_each(std::size_t pixel, const Visit &visit) const;

    const ThinLens &lens() const { return lens_; }
    const Ldi &ldi() const { return ldi_; }
    std::size_t alpha() const { return alpha_; } // channel, npos: none
    // Indices of the channels that are blended as colours: neither ids nor A, which is the coverage.
    const std::vector<std::size_t> &colours() const { return colours_; }

    double colour(const Splat &splat, std::size_t channel) const {
        return splat.sample == npos ? 0 : splat.scale * ldi_.values[channel][splat.sample];
    }

private:
    Splat background(std::size_t pixel, double passed) const;
    Imath::V2d position(std::size_t pixel, std::size_t sample) const;

    const Ldi &ldi_;
    Grid grid_;
    ThinLens lens_;
    std::size_t alpha_;
    const float *alphas_ = nullptr;
    std::vector<std::size_t> colours_;
};

// The image that a gather or scatter fills: channels of the LDI, ids already copied from the front samples.
Image image_with_ids(const Ldi &ldi);

// Sets what is blended: A and the colours, in the order of source.colours().
void set_pixel(Image &image, const SplatSource &source, int x, int y, double alpha,
               std::span<const double> colours);

template <typename Visit>
void SplatSource::for_each(std::size_t pixel, const Visit &visit) const {
    constexpr double too_little = 1e-7; // what rounding leaves of a covered pixel
    double passed = 1;                  // what the samples of the current layer let through
    std::optional<Splat> last;
    for (const std::uint64_t i : ldi_.pixel(pixel)) {
        const double alpha = alphas_ ? std::clamp(double(alphas_[i]), 0.0, 1.0) : 1.0;
        if (alpha <= 0) continue;
        const double coc = circle_of_confusion(lens_, ldi_.coc_z(i));
        const int bin = depth_bin(coc);
        const bool same_layer = last && kernels::joins_layer(bin, last->bin);
        if (same_layer && passed <= too_little) continue;
        if (last) {
            if (!same_layer) last->known += passed, passed = 1;
            visit(*last);
        }
        last = Splat{position(pixel, i), coc, bin, passed * alpha, passed * alpha, passed, i};
        passed *= 1 - alpha;
    }
    if (last) {
        last->known += passed;
        visit(*last);
    }
    if (passed > too_little) visit(background(pixel, passed));
}

// Splats of one bin of depth in a square of pixels. The bounds of a block (its position and reach) let a tile accept or
// reject it as a whole, so that a single huge circle of confusion costs only its own block.
struct SplatBlock {
    int bin = 0;
    std::size_t begin = 0, end = 0; // splats
    Imath::Box2d centres, reach;    // of the splats' centres; of all pixels that they can touch
    double smallest = 0;            // the smallest radius of a CoC
};

// The splats of an LDI in the order in which a gather needs them: cut into blocks, sorted front to back.
struct SplatBlocks {
    // One entry per splat, block by block.
    std::vector<double> x, y, radius;
    std::vector<float> values;         // [splat][size()]: coverage, known, colours, known * radius
    std::size_t colours = 0, bins = 0; // their numbers

    std::vector<SplatBlock> blocks; // ascending bins, then squares of pixels
    // [block][size()]: values / area of the PSF in pixels, where the block can cover a tile
    std::vector<double> sums;

    std::size_t size() const { return sums_before_colours + colours + 1; }
    std::span<const float> value(std::size_t splat) const {
        return std::span(values).subspan(splat * size(), size());
    }
};

SplatBlocks make_splat_blocks(const SplatSource &source);

} // namespace sparselens
