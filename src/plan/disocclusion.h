// What a view from the rim of the lens would show but the centre view does not, computed from the depth of the centre
// view alone: its pixels are moved to where the rim view sees them (docs/design.md section 1). Where no pixel lands,
// the rim view shows something else.
//
// Neighbouring pixels whose disparities differ by at most a pixel are one surface without cracks. Beyond the border of
// the picture the scene is assumed to continue like its edge.
#pragma once

#include "../base/image.h"
#include "../lens/thin_lens.h"

#include <concepts>
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
    std::size_t index(const std::same_as<Imath::V2i> auto &pixel) const { return grid().index(pixel); }
    bool at(const std::same_as<Imath::V2i> auto &pixel) const { return set[index(pixel)] != 0; }
    std::size_t count() const;
};

// The centre view as seen from the rim view: for each pixel, the disparity R F / z of the nearest pixel that
// lands in it, or `nothing`. The data window is the centre view's.
struct MovedDepth {
    static constexpr float nothing = -1;
    PixelMask edge;   // where something as near as the surfaces at the border may come in from beyond it
    PixelMask inside; // where pixels of the centre view land
    std::vector<float> depth; // of these pixels, or of the scene that is assumed beyond the border
};

// z: the planar depth of the pixels of windows.data, inf if empty; u: the lens point of the rim view.
MovedDepth move_depth(const Windows &windows, std::span<const float> z, const ThinLens &lens,
                      const Imath::V2d &u);

// The share of the pixels of windows.data beside a jump of depth, at the edges of nearer objects.
double share_at_edges(const Windows &windows, std::span<const float> z, const ThinLens &lens);

// The pixels of the rim view in which nothing lands.
PixelMask disoccluded(const MovedDepth &moved);

// The same, and the pixels that show the scene beyond the border of the centre view.
PixelMask unseen_by_centre(const MovedDepth &moved);

// The pixels of the rim view that show the pixels `of_centre`.
PixelMask pixels_that_show(const MovedDepth &moved, const PixelMask &of_centre, const ThinLens &lens,
                           const Imath::V2d &u);

// The mask without areas one pixel wide along either axis: they are hidden by thin objects such as wires and blades of
// grass, or open in a steep surface.
PixelMask without_slits(const PixelMask &mask);

// All pixels within `margin` pixels, along each axis, of set pixels.
PixelMask grown(const PixelMask &mask, int margin);

// A few rectangles that contain all pixels of a mask, because renderers crop by rectangles.

// At most `most` rectangles, which may overlap; none for an empty mask. EXR coordinates, corners included.
std::vector<Imath::Box2i> rectangles_over(const PixelMask &mask, std::size_t most = 64);

} // namespace sparselens
