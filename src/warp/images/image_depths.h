// At which depth the images lie that mirrors and glass show, for each pixel of the centre view: found where patches tell,
// made sure of by their neighbours, and continued to pixels of the same surface that do not tell.
#pragma once

#include "warp/images/disagreement.h"
#include "warp/images/image_sweep.h"
#include "warp/images/neighbours.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace sparselens {

// The blocks of `data` that are worth a search because they differ: not those that stand alone, as noise chooses such ones;
// and where they differ slightly not those that have fewer than two beside them.
std::vector<std::size_t> blocks_to_search(const Imath::Box2i &data, std::span<const Disagreement> differ);

// Perceptive depth of the image that a pixel shows; NaN: the pixel shows its surface, or nothing is known.
using ImageDepthAt = std::function<float(const Imath::V2i &pixel)>;
using ShowImages = std::function<void(const Imath::Box2i &block, const ImageDepthAt &depth_at)>;

// Searches those blocks, and others where it has found something beside them: show(block, depth_at) for each, in parallel, once what
// lies around it is known, too.
void find_image_depths(const ImageSweep &sweep, const Imath::Box2i &data,
                       const std::vector<std::size_t> &blocks, const ShowImages &show);

} // namespace sparselens
