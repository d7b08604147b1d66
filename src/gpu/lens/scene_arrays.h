// A scene of the lens gather, laid out as lens_tile.comp reads it. It has all samples. It stays on the device while
// tiles are gathered from it, and data that a new frame does not change are not copied again.
#pragma once

#include "dof/lens/gather_scene.h"
#include "kernels/lens_rules.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sparselens::gpu {

struct SceneArrays {
    // Samples: first those of the LDI, then fillers, then solids. Solids have no alphas and no colours.
    std::vector<std::array<float, 2>> places;
    std::vector<std::uint32_t> uppers; // halves of keys, with lens_kernel::hiding except for fillers
    std::vector<float> cocs, alphas;
    std::vector<float> shown;   // CoCs of what samples show; empty without mirrors and glass: as `cocs`
    std::vector<float> colours; // [group][sample][4]
    std::vector<std::uint32_t> solids;      // the sample that each solid shows
    std::vector<std::uint32_t> facets;      // three samples each
    std::vector<lens_kernel::Block> blocks; // of samples, of fillers, of solids and of facets
    std::vector<std::uint32_t> sets;        // [channel]: its ColourSet
};

SceneArrays arrays_of(const GatherScene &scene);

} // namespace sparselens::gpu
