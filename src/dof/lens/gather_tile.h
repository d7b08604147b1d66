// One tile of the lens picture: every lens point sees its own picture of the samples (see.h), and the mean over the lens points
// (weigh.h) is the tile.
#pragma once

#include "dof/device/tile_device.h"

#include <functional>

namespace sparselens {

// Calls done(picture) with it.
void gather_tile(const GatherScene &scene, const TileTask &tile,
                 const std::function<void(const TilePicture &)> &done);

} // namespace sparselens
