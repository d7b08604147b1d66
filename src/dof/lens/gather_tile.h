// Gathers one tile of the lens picture. Every lens point sees its own picture of the samples (see.h); the tile is the
// mean over the lens points (weigh.h).
#pragma once

#include "dof/device/tile_device.h"

#include <functional>

namespace sparselens {

// Calls done(picture) with the result.
void gather_tile(const GatherScene &scene, const TileTask &tile,
                 const std::function<void(const TilePicture &)> &done);

} // namespace sparselens
