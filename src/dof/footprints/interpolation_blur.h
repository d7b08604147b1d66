// How much the gather blurs a sample by sharing it between pixels, as interpolation does. The value is half of the mean
// of f (1 - f) over the lens, where f is the fraction of a pixel off the grid along one axis. It is the weight with
// which a second difference undoes the blur (dof/lens/sharpen.h says why).
#pragma once

#include "deep/ldi.h"
#include "lens/aperture.h"
#include "lens/thin_lens.h"

#include <array>
#include <cstdint>
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

// Finds which samples of the pixels beside a sample show the same surface.
inline constexpr std::uint64_t no_neighbour = ~std::uint64_t(0);

struct SurfaceNeighbours {
    std::array<std::uint64_t, 4> sample; // left, right, up, down; or no_neighbour
    // How far both neighbours of the axis show the surface, (0, 1]; 0: one of them is missing.
    float horizontal, vertical;
    double along(std::size_t neighbour) const { return double(neighbour < 2 ? horizontal : vertical); }
};

// Returns the neighbours of sample i in pixel (x, y), which is relative to the data window's corner. A neighbour is the
// sample of its pixel that is nearest in disparity, and closer than one_surface_px. From 3/4 of that distance on
// it shows the surface less and less, so that nothing changes suddenly as the aperture opens.
SurfaceNeighbours surface_neighbours(const Ldi &ldi, const ThinLens &lens, std::uint64_t i, int x, int y);

} // namespace sparselens
