#include "dof/lens/scene_blocks.h"

#include <algorithm>

namespace sparselens {

SceneBlocks::SceneBlocks(const GatherScene &scene)
    : scene_(scene), samples_(scene.samples, scene.optics->aperture, scene.pixel_aspect()),
      fillers_(scene.fillers.samples, scene.optics->aperture, scene.pixel_aspect()),
      solids_(scene.solids, scene.optics->aperture, scene.pixel_aspect()) {}

ReachingCocs SceneBlocks::find(const Imath::V2i &origin, int size, float stretched, TileBlocks &found) const {
    ReachingCocs cocs = samples_.find(origin, size, stretched, found.samples);
    for (const auto &[finder, blocks] :
         {std::pair(&fillers_, &found.fillers), std::pair(&solids_, &found.solids)})
        cocs.least = std::min(cocs.least, finder->find(origin, size, stretched, *blocks).least);
    find_blocks(scene_.facets, origin, size, stretched * extent(), found.facets);
    return cocs;
}

} // namespace sparselens
