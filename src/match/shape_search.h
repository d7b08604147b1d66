// Finds the shape of the lens of a plate, which the discs of lamps show: the blades of its aperture and its squeeze.
//
// Each shape is compared at the radius at which its area is that of the round lens that was found first, so that all
// shapes blur about equally.
#pragma once

#include "lens/lens_looks.h"
#include "match/lens_search.h"

#include <functional>

namespace sparselens {

// Like Comparison::gather, through a lens of this shape.
using ShapedGather = std::function<Rgb(const ApertureShape &shape, double coc, double scale, bool exactly)>;

struct ShapeFit {
    ApertureShape shape;
    LensFit fit;
    bool is_told = false; // another shape that was tried fits clearly worse
};

// Looks from `round`, which fits best among round lenses. Without a clear difference the result is that lens.
ShapeFit find_shape(const Comparison &pictures, const ShapedGather &gather, const KnownLens &known,
                    const BlurGuess &round);

} // namespace sparselens
