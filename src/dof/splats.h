// What the gather and the scatter spread: each sample of an LDI as seen by one lens, and the background that
// shines through what a pixel's samples leave uncovered.
#pragma once

#include "dof/blend.h"
#include "ldi/ldi.h"
#include "lens/thin_lens.h"

#include <Imath/ImathVec.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace sparselens {

struct Splat {
    Imath::V2d position;    // EXR pixel coordinates, inside the pixel that owns the sample
    double coc = 0;         // signed, pixels
    double coverage = 0;    // alpha of the sample; of the background: what is left of the pixel
    std::size_t sample = 0; // index in the LDI; npos: transparent background at infinity
};

class SplatSource {
public:
    SplatSource(const Ldi &ldi, const ThinLens &lens);

    // visit(splat) front to back for what pixel (row * width + column) holds; samples of no coverage are left
    // out.
    template <typename Visit>
    void for_each(std::size_t pixel, const Visit &visit) const;

    const ThinLens &lens() const { return lens_; }
    const Ldi &ldi() const { return ldi_; }
    std::size_t alpha() const { return alpha_; } // channel, npos: none
    // Indices of the channels that are blended as colours: neither ids nor A, which is the coverage.
    const std::vector<std::size_t> &colours() const { return colours_; }

private:
    Imath::V2d position(std::size_t pixel, std::size_t sample) const;

    const Ldi &ldi_;
    ThinLens lens_;
    std::size_t alpha_;
    const float *alphas_ = nullptr;
    std::vector<std::size_t> colours_;
};

inline int depth_bin(const Splat &splat) {
    return splat.sample == npos ? background_bin : depth_bin(splat.coc);
}

// The image that a gather or scatter fills: channels of the LDI, ids already copied from the front samples.
Image image_with_ids(const Ldi &ldi);

// Sets what is blended: A and the colours, in the order of source.colours().
void set_pixel(Image &image, const SplatSource &source, int x, int y, double alpha,
               std::span<const double> colours);

template <typename Visit>
void SplatSource::for_each(std::size_t pixel, const Visit &visit) const {
    constexpr double too_little = 1e-7; // what rounding leaves of a covered pixel
    double left = 1;
    for (std::size_t i = ldi_.begin[pixel]; i < ldi_.begin[pixel + 1]; ++i) {
        const double coverage = alphas_ ? std::clamp(double(alphas_[i]), 0.0, 1.0) : 1.0;
        if (coverage > 0)
            visit(Splat{position(pixel, i), circle_of_confusion(lens_, double(ldi_.z[i])), coverage, i});
        left *= 1 - coverage;
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (left > too_little)
        visit(Splat{position(pixel, npos), circle_of_confusion(lens_, infinity), left, npos});
}

} // namespace sparselens
