// How much the gather blurs a sample by sharing it between pixels, as interpolation does. The value is half of the mean
// of f (1 - f) over the lens, where f is the fraction of a pixel off the grid along one axis. It is the weight with
// which a second difference undoes the blur (dof/lens/sharpen.h says why).
#pragma once

#include "lens/aperture.h"

#include <vector>

namespace sparselens {

class InterpolationBlur {
public:
    static constexpr double largest_weight = 0.125; // f (1 - f) is at most 1/4

    // A null aperture is a disc.
    explicit InterpolationBlur(const Aperture *aperture);
    ~InterpolationBlur();

    // The weight along one axis. `coc`, and the sample's `offset` from the middle of its pixel, are in pixels along
    // that axis. The weight fades to 0 where the lens blurs so much that this blur does not show.
    double horizontal(double coc, double offset) const;
    double vertical(double coc, double offset) const;
    // Whether any CoC (along x) from `least` to `most` has a weight above 0.
    bool any(double least, double most, double pixel_aspect) const;

private:
    class Table;
    const Table &of(double coc, std::size_t axis) const;
    double squeeze_;
    std::vector<Table> tables_; // one for all, or four: in front along x and y, behind along x and y
};

} // namespace sparselens
