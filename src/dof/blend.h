// How the fragments that cover one destination pixel become its colour: the rule that the selective gather
// and the scatter share.
//
// A fragment is the share of a splat that its PSF brings to the pixel: coverage and premultiplied colours,
// both times the PSF's weight. Fragments are binned by CoC, which at a given focus is perceptive depth (R F /
// z) but for a constant; bins that follow each other without a gap are one layer, and layers are blended
// front to back. A layer whose coverage sums to C covers min(C, 1) of what the layers in front leave; the
// transparent background, which nothing can hide behind, covers min(B, what is left). What is then still left
// is unknown (nobody saw it) and the rest is scaled up to make good for it.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace sparselens {

// Bins are numbered front to back. Their width is half a pixel of CoC where the blur is small and a fixed
// share of the CoC where it is large, so that their number stays bounded.
int depth_bin(double coc);
inline constexpr int background_bin = std::numeric_limits<int>::max();

// Blends the layers of one pixel. Each layer is 1 + colours.size() sums: its coverage (> 0), then its
// colours; front to back. Sets the colours and returns alpha.
double blend_layers(std::span<const double> layers, double background, std::span<double> colours);

// The layers of a tile's pixels, grown bin by bin from front to back; where a pixel has more than the limit,
// the two layers with the narrowest gap between them are merged.
class TileLayers {
public:
    TileLayers(std::size_t pixels, std::size_t limit, std::size_t colours);

    void clear();
    // The sums of one bin at one pixel, in [1 + colours] arrays `stride` apart. Bins come in ascending order.
    void add(std::size_t pixel, int bin, const double *sums, std::size_t stride);
    double blend(std::size_t pixel, std::span<double> colours) const; // as blend_layers

private:
    struct State {
        std::size_t count = 0;
        int last_bin = 0;
        double background = 0;
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

} // namespace sparselens
