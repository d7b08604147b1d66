// Finds the depth of the images that mirrors and glass show, for each pixel of the centre view. Patches give depths,
// neighbours confirm them, and they are continued to pixels of the same surface whose patches give none.
#pragma once

#include "warp/images/image_sweep.h"
#include "warp/images/matched_view.h"
#include "warp/images/patch_comparison.h"

#include <functional>
#include <span>
#include <vector>

namespace sparselens {

// Returns the blocks of `data` that are worth a search because their views differ. A block is left out if no block
// beside it differs, because noise chooses single blocks, and if it differs slightly and fewer than two beside it
// differ.
std::vector<std::size_t> blocks_to_search(const Imath::Box2i &data, std::span<const Disagreement> differ);

// Disparity of the image that a pixel shows; NaN: the pixel shows its surface, or nothing is known.
using ImageDepthAt = std::function<float(const Imath::V2i &pixel)>;
using ShowImages = std::function<void(const Imath::Box2i &block, const ImageDepthAt &depth_at)>;

// Searches these blocks, and the blocks beside those in which many pixels find a depth. Calls show(block, depth_at) for
// each, in parallel, once what lies around the block is known, too.
void find_image_depths(const ImageSweep &sweep, const Imath::Box2i &data,
                       const std::vector<std::size_t> &blocks, const ShowImages &show);

// Gives the samples of an LDI that show mirrors and glass the depth of what they show, and averages the views at that
// depth.

// `ldi` is made of `views`, the centre view first; where the centre view shows one sample, it is the front sample of
// the LDI's pixel. `scale`: R F. `across`: pixels, across and down, that become one pixel of the picture. `differ`, by
// blocks of the LDI's data window: where views differ by more than noise if the picture lies on the
// surface. Ldi::image_z stays empty if no image is found.
void show_images(std::span<const PlacedView> views, double scale, int across,
                 std::span<const Disagreement> differ, Ldi &ldi);

} // namespace sparselens
