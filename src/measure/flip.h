// FLIP: how different two pictures look to a person who flips between them on a screen, in each pixel, from 0 to 1.
//
// P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astroem, M. Fairchild, "FLIP: A Difference Evaluator
// for Alternating Images", 2020. P. Andersson, J. Nilsson, P. Shirley, T. Akenine-Moeller, "Visualizing Errors in
// Rendered High Dynamic Range Images", 2021. It assumes 67 pixels per degree (flip_terms.h); beyond its border a
// picture continues like its edge.
#pragma once

#include "../base/image.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

enum class FlipRange {
    ldr, // values are shown unchanged, in [0, 1]
    hdr  // the worst of several exposures, tone-mapped by a film curve (ACES): from the one at which the
         // reference's brightest pixel is just not too bright, to the one at which its median is
};

// R, G and B (linear, Rec. 709 primaries) of pictures as rgba_over() (image_error.h) returns them, with the same data
// window. Negative values are black. A pixel is NaN if a channel of either picture is not finite; for its neighbours it
// is black in both.
std::vector<float> flip_map(const Image &image, const Image &reference, FlipRange range);

// The means of a map over all pixels, then over the pixels of each region (image_error()). Without pixels: NaN.
std::vector<double> flip_means(std::span<const float> map, std::span<const std::uint8_t> region_bits = {},
                               std::size_t regions = 0);

// The exposures of FlipRange::hdr, as factors on linear RGB.
std::vector<double> flip_exposures(const Image &reference);

} // namespace sparselens
