// What a view from the rim of the lens would show but the centre view does not, found from the depth of the centre
// alone: its pixels are moved to where the rim view sees them (docs/design.md section 1). Where none lands, the rim
// view shows something else.
//
// Neighbouring pixels whose positions differ by at most a pixel are one surface without cracks. Beyond the border of
// the picture the scene is assumed to continue like its edge.
#pragma once

#include "../base/image.h"
#include "../lens/thin_lens.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// One value per pixel of a data window.
struct PixelMask {
    Imath::Box2i data{{0, 0}, {-1, -1}};
    std::vector<std::uint8_t> set; // 0 or 1, row by row

    PixelMask() = default;
    explicit PixelMask(const Imath::Box2i &window) : data(window), set(grid().size()) {}
    Grid grid() const { return Grid(data); }
    int width() const { return grid().width(); }
    int height() const { return grid().height(); }
    std::size_t index(int x, int y) const { return grid().index(x, y); }
    bool at(int x, int y) const { return set[index(x, y)] != 0; }
    std::size_t count() const;
};

// The centre view as seen from the rim view: the perceptive depth R F / z of the nearest pixel that lands in each
// pixel, or `nothing`. The data window is that of the centre view.
struct MovedDepth {
    static constexpr float nothing = -1;
    PixelMask edge;   // where something may come in from beyond the frame, as near as what stands at its edge
    PixelMask inside; // where something lands that the centre view shows
    std::vector<float> depth; // of that, or of what goes on beyond the frame
};

// z: the planar depth of the pixels of windows.data, inf where they are empty; u: the lens point of the rim view.
MovedDepth move_depth(const Windows &windows, std::span<const float> z, const ThinLens &lens,
                      const Imath::V2d &u);

// The share of the pixels of windows.data that lie beside a jump of depth, at the edges of nearer objects.
double share_at_edges(const Windows &windows, std::span<const float> z, const ThinLens &lens);

// The pixels of the rim view in which nothing lands.
PixelMask disoccluded(const MovedDepth &moved);

// The same, and the pixels that show what lies beyond the border of the centre view.
PixelMask unseen_by_centre(const MovedDepth &moved);

// The pixels of the rim view that show those of the centre view.
PixelMask pixels_that_show(const MovedDepth &moved, const PixelMask &of_centre, const ThinLens &lens,
                           const Imath::V2d &u);

// The mask without areas one pixel wide along either axis: thin objects, such as wires and blades of grass, hide them,
// or a steep surface opens there.
PixelMask without_slits(const PixelMask &mask);

// All pixels within `margin` pixels, along each axis, of those that are set.
PixelMask grown(const PixelMask &mask, int margin);

} // namespace sparselens
