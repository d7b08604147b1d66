// The splats that the gather and the scatter spread: each sample of an LDI as seen by one lens, and the background that
// shines through where a pixel's samples leave it uncovered.
#pragma once

#include "deep/ldi.h"
#include "dof/selective/blend.h"
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

// Samples of a pixel that fall into one layer (blend.h) hide each other here, in the pixel; samples of different layers
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
        const double coc = circle_of_confusion(lens_, ldi_.optical_z(i));
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
