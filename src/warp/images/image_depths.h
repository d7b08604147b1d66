// Finds the depth of the images that mirrors and glass show, for each pixel of the centre view. Patches give depths,
// neighbours confirm them, and they are continued to pixels of the same surface whose patches give none.
#pragma once

#include "warp/images/disagreement.h"
#include "warp/images/image_sweep.h"
#include "warp/images/neighbours.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace sparselens {

// Returns the blocks of `data` that are worth a search because their views differ. Blocks that stand alone are left
// out, because noise chooses such blocks; so are blocks that differ slightly and have fewer than two such blocks beside
// them.
std::vector<std::size_t> blocks_to_search(const Imath::Box2i &data, std::span<const Disagreement> differ);

// Perceptive depth of the image that a pixel shows; NaN: the pixel shows its surface, or nothing is known.
using ImageDepthAt = std::function<float(const Imath::V2i &pixel)>;
using ShowImages = std::function<void(const Imath::Box2i &block, const ImageDepthAt &depth_at)>;

// Searches these blocks, and blocks beside which it has found something. Calls show(block, depth_at) for each, in
// parallel, once what lies around the block is known, too.
void find_image_depths(const ImageSweep &sweep, const Imath::Box2i &data,
                       const std::vector<std::size_t> &blocks, const ShowImages &show);

} // namespace sparselens
