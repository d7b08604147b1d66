// Continues the picture beyond the frame, the window of which everything is known. A surface that leaves the frame
// continues as it leaves; an empty border stays empty.
//
// A pixel beyond the frame continues the nearest pixel of the frame: it has the same samples, with their coverage,
// depth and position in the pixel, and is transparent to infinity if that pixel is. If there are samples beyond a side,
// rim views looked past the frame there, by the disparity of what they saw: n pixels from the frame they showed
// everything nearer than n - 1/2 pixels. A sample then continues from the last pixel in which they could see it, or
// from the last but one if they saw nothing of its surface in the last, where parallax may tear it. A surface that they
// saw end ends, and a surface that only they saw continues too. Past corners, samples continue that continue both above
// or below the frame and beside it. If that leaves out the last sample of the frame's pixel, the pixel is unknown.
//
// Beyond other sides, an opaque surface in front ends like similar surfaces: those that the row shows whole within 96
// pixels, nearer than their surroundings on both sides, as near as it (one_surface_px) and at most one pixel narrower.
// It becomes as wide as the narrowest of them, and its neighbour in the frame continues beyond it. If there are none,
// it continues itself.
//
// A small light continues as a disc, so that a lamp leaves no streak. A light is small if it is brighter than four
// times the level that four of five pixels up to 32 away along the border stay below. Its width where it was last seen,
// and 2 pixels before (1 if it was not that long), tells how far its disc reaches; n times as far, 1 / n^2 of its light
// is left.
#pragma once

#include "deep/ldi.h"
#include "lens/thin_lens.h"

#include <utility>
#include <vector>

namespace sparselens {

struct FrameExtension {
    Ldi ldi; // its data window grown by whole cells of 32 pixels, so that samples are kept in the same blocks
    // The pixels that are transparent to infinity if they are empty, except those marked in `unseen`,
    // [pixel of the data window].
    Imath::Box2i known;
    std::vector<char> unseen;
};

// `known`: the rows of the frame whose samples the LDI has. The picture is continued only beyond those of its sides
// that are sides of the frame. `across`: pixels, across and down, that become one pixel of the picture; the distances
// above are counted in pixels of the picture, except what rim views saw. `views_radius`: the radius of the lens from
// whose rim the views looked, scene units; disparity in the pixels of that lens says what they saw. 0: the
// radius of `lens`.
FrameExtension extend_beyond_frame(Ldi ldi, const ThinLens &lens, const Imath::Box2i &frame,
                                   const Imath::Box2i &known, const Imath::V2i &reach, int across = 1,
                                   double views_radius = 0);

// Returns gather(ldi, options.lens) of the continued LDI, or of `ldi` itself if options.beyond is not set
// (dof/methods.h). Pass an Ldi&& if `ldi` may be used up, else a const Ldi&.
template <typename AnyLdi, typename Options, typename Gather>
auto gather_beyond(AnyLdi &&ldi, const ThinLens &lens, const Imath::Box2i &window, const Options &options,
                   const Gather &gather) {
    if (!options.beyond) return gather(ldi, options.lens);
    auto by = options.lens;
    const FrameExtension all =
        extend_beyond_frame(std::forward<AnyLdi>(ldi), lens, options.beyond->frame, by.known.value_or(window),
                            options.beyond->reach, by.across, options.views_radius);
    by.known = all.known;
    by.unseen = all.unseen;
    by.seen = options.beyond->frame;
    return gather(all.ldi, by);
}

} // namespace sparselens
