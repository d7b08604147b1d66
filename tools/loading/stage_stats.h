// The figures of each stage for its line of --stats.
#pragma once

#include "deep/cluster.h"
#include "deep/packed_view.h"
#include "dof/lens/lens_tiles.h"
#include "harness/stats.h"
#include "loading/ldi_cache.h"
#include "plan/plan.h"

#include <span>

namespace sparselens {

Stats plan_stats(const Plan &plan, int views_allowed, const Windows &centre);
// What views give to a warp, which takes their pixels.
struct GivenViews {
    std::size_t views, empty, pixels, all_pixels;
};
GivenViews given_views(std::span<const PackedView> views);
Stats warp_stats(const GivenViews &given, const Ldi &ldi);
Stats cluster_stats(const OpenedLdi &in, const Clustered &out);
Stats gather_stats(const LdiCache &cache, std::size_t samples,
                   const LensTiles &tiles); // no tiles: not gathered by tiles

} // namespace sparselens
