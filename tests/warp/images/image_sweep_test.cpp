// For near surfaces, a smaller picture first selects which depths to try: its results compared with trying all.
#include "support/views.h"
#include "warp/images/image_sweep.h"
#include "warp/images/matched_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace sparselens {
namespace {

constexpr double focal_px = 200, radius = 0.12, scale = focal_px * radius;
const Windows window = windows_of_size(200, 120);

// All positions differ.
float blotches(double x, double y) {
    double sum = 0;
    for (int n = 0; n < 6; ++n)
        sum += std::sin(x * std::cos(2.1 * n) / (3 + n) + y * std::sin(2.1 * n) / (3 + n) + n);
    return float(0.5 + 0.08 * sum);
}

// A wall near the camera on which each camera sees a texture at depth `image_z`.
struct Mirror {
    Mirror(double wall_z, double image_z) {
        const double moves = focal_px * (1 / wall_z - 1 / image_z);
        for (const Imath::V2d &u :
             {Imath::V2d(0, 0), Imath::V2d(1, 0), Imath::V2d(0, 1), Imath::V2d(-1, 0), Imath::V2d(0, -1)}) {
            const Imath::V2d camera = radius * u;
            TwoPlanes scene{.focal_px = focal_px};
            scene.front_z = wall_z;
            scene.front_covers = [](double, double) { return true; };
            scene.front_red = [=](double x, double y) {
                return blotches(x - moves * camera.x, y + moves * camera.y);
            };
            pictures.push_back(scene.view(window, camera));
        }
        for (const View &picture : pictures) {
            samples.push_back(std::make_unique<ViewSamples>(picture, picture.image.channels));
            mappings.push_back(std::make_unique<ViewMapping>(picture.position, focal_px, window));
            views.emplace_back(PlacedView{samples.back().get(), mappings.back().get()}, scale);
        }
    }

    std::vector<View> pictures;
    std::vector<std::unique_ptr<ViewSamples>> samples;
    std::vector<std::unique_ptr<ViewMapping>> mappings;
    std::vector<MatchedView> views;
};

std::vector<std::size_t> all_blocks() {
    std::vector<std::size_t> blocks(Tiles(window.data, image_block).count());
    for (std::size_t n = 0; n < blocks.size(); ++n) blocks[n] = n;
    return blocks;
}

TEST(ImageSearch, FindsByASmallerPictureWhatTryingAllDepthsFinds) {
    for (const auto &[wall_z, image_z] : {std::pair(1.0, 2.0), std::pair(0.35, 0.6), std::pair(0.7, -9.0)}) {
        Mirror mirror(wall_z, image_z);
        const ImageSweep sweep(mirror.views, 1);
        const Tiles tiles(window.data, image_block);
        ASSERT_TRUE(sweep.has_many_depths(tiles.box(9)));
        const ImageSearch search(sweep, window.data, all_blocks());
        int found = 0, same = 0;
        for (std::size_t tile = 0; tile < tiles.count(); ++tile) {
            const std::vector<ImageMatch> slowly = sweep.search(tiles.box(tile));
            const Grid pixels(tiles.box(tile));
            for (std::size_t n = 0; n < pixels.size(); ++n) {
                if (!slowly[n].found) continue;
                const ImageMatch &match = search.matches[search.index_of(pixels.pixel(n))];
                ++found;
                same += match.found && match.depth == slowly[n].depth;
            }
        }
        EXPECT_GT(found, 10000) << wall_z;
        EXPECT_GT(same, 0.98 * found) << wall_z;
    }
}

TEST(ImageSearch, WhereTheSmallerPictureShowsNothingNoDepthIsTried) {
    Mirror near_by(1, 2), far_off(3, 6);
    const Imath::Box2i block({80, 40}, {87, 47});
    const auto found = [&](Mirror &mirror, const std::optional<std::vector<float>> &guesses) {
        int count = 0;
        for (const ImageMatch &match : ImageSweep(mirror.views, 1).search(block, guesses))
            count += match.found;
        return count;
    };
    EXPECT_EQ(found(near_by, {}), 64);
    EXPECT_EQ(found(near_by, std::vector{12.4f}), 64);
    EXPECT_EQ(found(near_by, std::vector{30.0f}), 0);
    EXPECT_EQ(found(near_by, std::vector<float>()), 0);
    EXPECT_EQ(found(far_off, std::vector<float>()), 64); // it has few depths to try
}

TEST(ImageSearch, GuessesAreOfThePixelsAround) {
    ImageGuesses guesses{windows_of_size(40, 30).grid(), std::vector<float>(1200, NAN)};
    guesses.depths[guesses.grid.index(Imath::V2i(20, 10))] = 3;
    EXPECT_EQ(guesses.near({{40, 16}, {47, 23}}), std::vector{6.0f});
    EXPECT_EQ(guesses.near({{32, 24}, {39, 31}}), std::vector{6.0f});
    EXPECT_TRUE(guesses.near({{48, 16}, {55, 23}}).empty());
    EXPECT_TRUE(guesses.near({{72, 56}, {79, 59}}).empty());
}

} // namespace
} // namespace sparselens
