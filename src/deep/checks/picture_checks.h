// Checks that find pictures that are read wrongly, views that were rendered through a lens, and mixed-up units.
#pragma once

#include "base/grid.h"
#include "deep/view_samples.h"
#include "lens/thin_lens.h"
#include "view/flat_pixels.h"
#include "view/view.h"

#include <cstddef>
#include <span>
#include <vector>

namespace sparselens {

// Whether the colours of a picture were encoded for a display (sRGB) but are read as linear light.
//
// A pixel on an edge mixes the surfaces on its two sides, and light mixes linearly: its colour lies on the line between
// their colours. In encoded pictures the line becomes a curve, by the transfer function of IEC 61966-2-1. For a colour
// between two others, the points on the line and on the curve are known, and a mixture lies beside one of them. The
// colour of a third surface may lie anywhere, so it does not count. Views of one sample per pixel mix nothing.
//
// Counts of pixels between two sides: all; those near the point on the line; those near the point on the curve; and
// those near a point as far beyond the curve, which only chance and noise reach. "Near" is less than half the way from
// line to curve.
struct EdgeMixing {
    std::size_t pixels = 0, light = 0, encoded = 0, beyond = 0;
};

EdgeMixing mixing_at_edges(const View &view);

// Whether the curve explains a tenth of the pixels or more, and exceeds the line and chance by three standard
// deviations. Greys, black and colours above 1 are not counted.
bool looks_encoded(const EdgeMixing &mixing);

// Whether the colours of a picture are multiplied by their coverage, as they must be.
//
// Over an edge of one to twelve pixels, from an opaque surface to nothing, coverage falls from 1 to 0. Premultiplied
// colours fall with it, while unpremultiplied ones stay as bright as the surface. Light that is added without coverage
// (glows, flames) cannot tell the two apart, so the pixels beyond the edge have to be black.
struct EdgeFall {
    std::size_t pixels = 0; // on such edges
    double stays = 0; // median of how far they stay bright: 0 if colours fall with coverage, 1 if they do not
};

EdgeFall fall_at_edges(const FlatPixels &pixels);

bool looks_unpremultiplied(const EdgeFall &fall);

// Whether depth follows coverage along soft edges, as if it had been filtered or premultiplied like a colour.
//
// From an opaque pixel of depth z0 outwards, where coverage A falls, the depth stays z0 if each pixel has that of its
// surface. A depth that was averaged with one of b behind is A z0 + (1 - A) b; b is 0 if it was multiplied by A.
struct EdgeDepths {
    std::size_t pixels = 0;     // of such edges, with A from 0.1 to 0.9
    std::size_t multiplied = 0; // those with b near 0
    std::size_t averaged = 0;   // those with b far behind z0, and the same for most
};

EdgeDepths depths_at_edges(const View &view);

// Whether four of five such pixels, 50 or more, are explained so.
bool looks_multiplied(const EdgeDepths &depths);
bool looks_averaged(const EdgeDepths &depths);

// Whether a picture that shows something has a coverage of 0 everywhere.
bool lacks_coverage(const View &view);

// Whether depths are planar, or linear in 1 / z: 1 / z itself, or a depth buffer's number from 0 to 1.
//
// On a plane 1 / z is linear across the picture. So in the middle between two pixels of one surface, z is the harmonic
// mean of their depths, and a depth that is linear in 1 / z is the plain mean.
struct DepthSlopes {
    std::size_t slopes = 0; // places where a surface recedes enough to tell
    double planar = 0;      // the share of them at the harmonic mean
    double inverse = 0;     // the share at the plain mean
};

DepthSlopes slopes_of_depth(const View &view);

// In 33 rendered and traced pictures, 0.82 to 1 of the slopes are planar and at most 0.02 inverse, except in one
// picture of round things alone, with 0.2 planar and 0.03 inverse. With 1 / z in place of z, 0.81 to 1 are inverse;
// only macro has 0.19, and is not noticed. False if there are too few slopes, because surfaces that face the camera do
// not recede.
bool looks_inverse(const DepthSlopes &slopes);

// Whether depths from 0 to 1 are normalised with 1 near the camera, but read as planar depths.
//
// Along a plane that recedes, 1 / z is linear across the picture. So z grows faster and faster with the distance, and a
// number that falls linearly with z falls faster and faster.
struct DepthBends {
    std::size_t slopes = 0; // places where a surface recedes smoothly
    double upward = 0;      // the share of them that bend as planar depths do
    double downward = 0;    // the share of them that bend the other way
};

DepthBends bends_of_depth(const ArrayGrid &grid, std::span<const float> depths);

// Whether no depth is above 1, and the slopes bend downward.
bool looks_white_near(const ArrayGrid &grid, std::span<const float> depths);

// Whether a view was rendered through a lens, with depth of field, and not through a pinhole. Its edges are then
// blurred already, and would be blurred again.
struct EdgeSharpness {
    std::size_t edges = 0; // edges of surfaces out of focus before others, with a clear difference of colour
    // The median, over these edges, of the largest change of colour in three pixels, relative to the step: about 1
    // through a pinhole, and through a lens at most 6 / (pi c), with c the CoC, which is 4 pixels or more.
    double steepest = 0;
    // How much two neighbouring pixels differ where all is out of focus, relative to two pixels that are eight apart: 2
    // / 23 if edges are sharp, more if there are strands or textures, a quarter of it if edges are spread over a CoC of
    // 4. Differences are squared, and count as far as two neighbouring lines agree, so that noise adds nothing.
    double fine = 1;          // also if nothing can be measured
    double fine_in_focus = 1; // the same where the CoC is below a pixel
};

EdgeSharpness sharpness_of_edges(const View &view, const ThinLens &lens);

// Whether edges are blurred, and everything else out of focus too: the edges of fur are soft, but its strands are not.
// In some 50 rendered and traced pictures, the median of edges is 0.78 and more through a pinhole, but from 0.51 in
// fur; through a lens it is 0.3 to 0.67, and more where little is out of focus. `fine` is 0.095 to 0.2 through a
// pinhole, 0.13 to 0.2 in fur, 0.02 where textures are smooth, and 0.02 to 0.065 through a lens. A lens shows 1.8 times as
// much and more in focus; a picture that is as soft there was filtered. False if there are too few edges to tell.
bool looks_defocused(const EdgeSharpness &sharpness);

// Finds mixed-up units, such as millimetres for scene units or centimetres for metres, by the lens and the view
// positions.

// The largest circle of confusion of the depths of a view, in pixels; 0 if the view shows nothing.
double largest_circle_of_confusion(std::span<const float> depths, const ThinLens &lens);

// Whether the lens leaves the picture as it is, because the blur is narrower than a pixel everywhere. A unit that is
// wrong by 100 or 1000 does that to nearly every shot. A lens of radius 0 is meant to do it, and does not count.
bool blurs_nothing(double largest_coc, const ThinLens &lens);

// The views that stand farther than three lens radii from the centre. The lens sees nothing from there, and mixed-up
// units differ by ten and more.
std::vector<std::size_t> views_beyond_lens(std::span<const PackedView> views, double lens_radius);

// Rows and columns of a picture, spread evenly over it, enough of them to judge the whole picture.

// Pixels of a row or column, from the index of the first, `step` apart.
struct PictureLine {
    std::size_t first, step, length;
    std::size_t operator[](std::size_t i) const { return first + i * step; }
};

template <typename Visit> // visit(PictureLine)
void visit_lines(const ArrayGrid &grid, const Visit &visit) {
    constexpr std::size_t most = 512; // of each
    const auto width = std::size_t(grid.width()), height = std::size_t(grid.height());
    for (std::size_t y = 0; y < height; y += pieces_of(height, most)) visit(PictureLine{y * width, 1, width});
    for (std::size_t x = 0; x < width; x += pieces_of(width, most)) visit(PictureLine{x, width, height});
}

} // namespace sparselens
