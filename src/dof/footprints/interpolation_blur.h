// How much the gather blurs a sample by sharing it between pixels, as interpolation does: half of the mean of f (1 - f)
// over the lens, f the fraction off the grid along one axis. That is the weight by which a second difference undoes it
// (dof/lens/sharpen.h, which says why).
#pragma once

#include "lens/aperture.h"

#include <vector>

namespace sparselens {

class InterpolationBlur {
public:
    static constexpr double largest_weight = 0.125; // f (1 - f) is at most 1/4

    // The aperture; null: a disc.
    explicit InterpolationBlur(const Aperture *aperture);
    ~InterpolationBlur();

    // CoCs and offsets of samples from the middle of a pixel, in pixels, along the axis. Fades to 0 where the blur of the
    // lens is so large that this one does not show.
    double horizontal(double coc, double offset) const;
    double vertical(double coc, double offset) const;
    // Whether any CoC (along x) from `least` to `most` has a weight above 0.
    bool any(double least, double most, double pixel_aspect) const;

private:
    class Table;
    const Table &of(double coc, std::size_t axis) const;
    double squeeze_;
    std::vector<Table> tables_; // one for all; or in front along x, along y, behind along x, along y
};

} // namespace sparselens
