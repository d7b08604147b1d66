// How the fragments that cover one destination pixel become its colour: the rule that the selective gather
// and the scatter share.
//
// A fragment is the share of a splat that its PSF brings to the pixel: coverage, what is known of it (below) and
// premultiplied colours, times the PSF's weight. Fragments are binned by CoC, which at a given focus differs from
// perceptive depth (R F / z) only by a sign and a constant. Bins that follow each other without a gap are one layer,
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
#pragma once

#include <Imath/ImathBox.h>

#include <cstddef>
#include <span>
#include <vector>

namespace sparselens {

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

} // namespace sparselens
