#include "dof/lens/gather_tile.h"

#include "dof/lens/see.h"
#include "dof/lens/weigh.h"

#include <algorithm>
#include <array>
#include <span>

namespace sparselens {

namespace {

template <typename Light>
void gather_by(const GatherScene &scene, const TileTask &tile,
               const std::function<void(const TilePicture &)> &done) {
    See see(scene, tile);
    Weigh<Light> weigh(scene, see.seen());
    for (const LensSample &point : tile.lens) weigh.add(see.through(point), point);
    done(weigh.picture());
}

// Whether any sample of some blocks may lie in front of focus.
bool reaches_in_front(const BlockedSamples &samples, std::span<const std::uint32_t> blocks) {
    return std::ranges::any_of(blocks, [&](std::uint32_t b) {
        return samples.blocks[b].begin != samples.blocks[b].end && samples.blocks[b].coc_min < 0;
    });
}

} // namespace

void gather_tile(const GatherScene &scene, const TileTask &tile,
                 const std::function<void(const TilePicture &)> &done) {
    const bool rims = std::ranges::any_of(
        tile.lens, [](const LensSample &p) { return p.behind != no_factors || p.in_front != no_factors; });
    const bool coloured =
        std::ranges::any_of(tile.lens, [](const LensSample &p) { return p.rgb != no_factors; });
    if (rims && (reaches_in_front(scene.samples, tile.samples) ||
                 reaches_in_front(scene.fillers.samples, tile.fillers)))
        gather_by<ChannelLight<2>>(scene, tile, done);
    else if (rims || coloured || scene.cat_eye())
        gather_by<ChannelLight<1>>(scene, tile, done);
    else
        gather_by<EvenLight>(scene, tile, done);
}

} // namespace sparselens
