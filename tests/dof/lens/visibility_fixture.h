// A hand-made tile of 64 x 64 pixels for tests of VisibilityPass and Accumulator.
#pragma once

#include "blocked_fixture.h"
#include "dof/lens/visibility.h"
#include "support/lens_ldi.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <numeric>
#include <vector>

namespace sparselens {

struct TileFixture {
    static constexpr ThinLens lens{
        .radius = 0.06, .focal_px = 640, .focus = 5}; // CoC up to 7.7 px behind focus

    Ldi ldi; // channels Y and A
    BlockedLdi blocked;
    FillerSamples fillers; // none
    PlacedFacets facets;
    std::vector<LensSample> points;
    std::vector<std::uint32_t> blocks;

    TileFixture(const std::function<std::vector<Sample>(int x, int y)> &samples_at,
                std::vector<LensSample> lens_points)
        : ldi(make_ldi(windows_of_size(64, 64), {{"Y"}, {"A"}}, samples_at)), blocked(ldi, lens),
          fillers(place_fillers(ldi, lens, {}, blocked.samples, blocked.colours)),
          points(std::move(lens_points)), blocks(blocked.samples.blocks.size()) {
        std::iota(blocks.begin(), blocks.end(), 0u);
        blocked.colours.sets.assign(4, data);
        blocked.colours.sets[0] = green;
        blocked.colours.sets[1] = coverage;
    }
    GatherScene scene(const LensLooks &looks = {}) const {
        return {&ldi,
                ldi.windows.data,
                lens,
                std::make_unique<Optics>(ldi, lens, looks, 0),
                {},
                blocked.samples,
                blocked.colours,
                {},
                fillers,
                facets};
    }
    TileTask task() const { return {{0, 0}, blocks, {}, {}, points}; }
    // The sample with this index in a pixel.
    std::uint32_t sample(int x, int y, std::size_t place = 0) const {
        const std::size_t source = ldi.begin[std::size_t(y * 64 + x)] + place;
        const auto &sources = blocked.samples.source;
        return std::uint32_t(std::ranges::find(sources, source) - sources.begin());
    }
};

// What the first lens point sees of a tile.
struct Seen {
    static constexpr std::uint32_t nothing = ~0u;
    GatherScene scene;
    TileTask task;
    VisibilityPass visibility;
    const Visibility &by_point = visibility.through(task.lens.front());

    explicit Seen(const TileFixture &tile, const BlockedSamples &solids = {})
        : scene(tile.scene()), task(tile.task()), visibility(pass(solids, tile.blocks)) {}

    VisibilityPass pass(const BlockedSamples &solids, const std::vector<std::uint32_t> &blocks) {
        scene.solids = solids;
        if (solids.count() > 0) task.solids = blocks;
        return {scene, task};
    }
    // The samples at a pixel: the opaque one, and what it shows.
    std::uint32_t front(int x, int y) const { return sample(by_point.front, x, y); }
    std::uint32_t shown(int x, int y) const { return sample(by_point.shown(), x, y); }

private:
    std::uint32_t sample(const std::vector<CellWord> &words, int x, int y) const {
        const std::uint32_t number = visibility.samples().number_of(words[tile_cells::at(x, y)]);
        return number == 0 ? nothing : visibility.samples().shown[number].sample;
    }
};

// An opaque sample with that CoC and value.
inline Sample opaque_at(double coc, float value = 1) {
    return {depth_of(TileFixture::lens, coc), {value, 1}};
}
inline Sample partial_at(double coc, float alpha, float value = 1) {
    return {depth_of(TileFixture::lens, coc), {alpha * value, alpha}};
}

} // namespace sparselens
