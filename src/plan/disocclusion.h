// What a view from the rim of the lens would show and the centre view does not, found from the centre's depth alone:
// its pixels are moved to where the rim view sees them (design.md section 1); where none lands, something else shows.
//
// Neighbouring pixels whose places differ by no more than a pixel are one surface, which has no cracks. What lies
// beyond the frame is taken to go on as the frame's edge does.
#pragma once

#include "../base/image.h"
#include "../lens/thin_lens.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// One value a pixel of a data window.
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

// The rim view's picture of the centre view: perceptive depth R F / z of what lands in each of its pixels, the
// nearest; `nothing` where none does. The data window is the centre view's.
struct MovedDepth {
    static constexpr float nothing = -1;
    PixelMask edge;   // where something may come in from beyond the frame, as near as what stands at its edge
    PixelMask inside; // where something lands that the centre view shows
    std::vector<float> depth; // of that, or of what goes on beyond the frame
};

// z: planar depth of the pixels of windows.data, inf where nothing is; u: the rim view's lens point.
MovedDepth move_depth(const Windows &windows, std::span<const float> z, const ThinLens &lens,
                      const Imath::V2d &u);

// Pixels of the rim view that nothing lands in, cracks one pixel wide closed.
PixelMask disoccluded(const MovedDepth &moved);

// The same, and those that show what lies beyond the centre view's frame.
PixelMask unseen_by_centre(const MovedDepth &moved);

// Everything within `margin` pixels (largest of both axes) of what is set.
PixelMask grown(const PixelMask &mask, int margin);

} // namespace sparselens
