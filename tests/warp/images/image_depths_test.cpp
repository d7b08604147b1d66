// Walls that are mirrors: the views show that their images are at another depth than the walls.
#include "support/views.h"
#include "warp/images/image_depths.h"
#include "warp/warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

namespace sparselens {
namespace {

constexpr double focal_px = 200, radius = 0.12, scale = focal_px * radius;
constexpr double wall_z = 3;
const Windows window = windows_of_size(96, 72);

using Texture = float (*)(double x, double y);

float waves(double x, double y) {
    return float(0.5 + 0.2 * std::sin(0.55 * x + 0.1 * y) + 0.2 * std::sin(0.13 * x - 0.6 * y + 1));
}
float grey(double, double) { return 0.5f; }

// A wall on which each camera sees a texture at depth `image_z`.
std::vector<View> mirror(double image_z, const Texture &texture = waves, float noise = 0) {
    std::vector<View> views;
    for (const Imath::V2d &u :
         {Imath::V2d(0, 0), Imath::V2d(1, 0), Imath::V2d(0, 1), Imath::V2d(-1, 0), Imath::V2d(0, -1)}) {
        const Imath::V2d camera = radius * u;
        // On the wall the image moves by the difference of the parallaxes of both depths.
        const double moves = focal_px * (1 / wall_z - 1 / image_z);
        TwoPlanes scene{.focal_px = focal_px};
        scene.front_z = wall_z;
        scene.front_covers = [](double, double) { return true; };
        scene.front_red = [=](double x, double y) {
            return texture(x - moves * camera.x, y + moves * camera.y);
        };
        scene.noise = noise;
        views.push_back(scene.view(window, camera));
    }
    return views;
}

Ldi warped(const std::vector<View> &views, bool find_images = true, int across = 1) {
    Progress silent;
    return warp(views, {.focal_px = focal_px, .radius = radius, .find_images = find_images, .across = across},
                silent);
}

// For the centre view's pixels except the outermost: the share whose front sample has an image, and the share whose
// image is within this disparity, in pixels, of the right one.
struct Shares {
    double found = 0, right = 0;
};

Shares shares(const Ldi &ldi, double image_z, double within) {
    constexpr int border = 12;
    Shares shares;
    int pixels = 0;
    for (int y = border; y < window.height() - border; ++y)
        for (int x = border; x < window.width() - border; ++x, ++pixels) {
            const std::uint64_t i = ldi.pixel(ldi.windows.index(Imath::V2i(x, y))).front();
            if (ldi.image_z.empty() || ldi.image_z[i] == ldi.z[i]) continue;
            shares.found += 1;
            shares.right += std::abs(scale / ldi.coc_z(i) - scale / image_z) < within;
        }
    return {shares.found / pixels, shares.right / pixels};
}

// Marks of 5 x 5 blocks, row by row: C for clearly different, s for slightly different. Returns x for blocks that are
// searched.
std::string searched(const std::string &marks) {
    const Imath::Box2i data({0, 0}, {5 * image_block - 1, 5 * image_block - 1});
    std::vector<Disagreement> differ;
    for (const char mark : marks) {
        using enum Disagreement;
        differ.push_back(mark == 'C' ? clear : mark == 's' ? slight : none);
    }
    std::string found(marks.size(), '.');
    for (const std::size_t block : blocks_to_search(data, differ)) found[block] = 'x';
    return found;
}

TEST(Images, BlocksThatStandAloneAreNotSearchedNorSlightPairs) {
    const std::string nothing(25, '.');
    EXPECT_EQ(searched("C......C.......s.s......."), nothing); // apart
    EXPECT_EQ(searched("ss.....................ss"), nothing);
    EXPECT_EQ(searched("CC.....................Cs"), "xx.....................x.");
    EXPECT_EQ(searched("sss..sss..sss............"), "xxx..xxx..xxx............");
}

TEST(Images, DepthsBehindTheMirrorBeforeItAndBehindTheCamera) {
    for (const double image_z : {6.0, 20.0, 2.2, -30.0}) {
        const Shares found = shares(warped(mirror(image_z)), image_z, 0.01);
        EXPECT_GT(found.found, 0.95) << image_z;
        EXPECT_GT(found.right, 0.95) << image_z;
    }
}

TEST(Images, SurfacesHaveNone) {
    EXPECT_TRUE(warped(mirror(wall_z)).image_z.empty());
    EXPECT_TRUE(warped(mirror(wall_z, waves, 0.2f)).image_z.empty());
    EXPECT_TRUE(warped(mirror(wall_z, grey, 0.3f)).image_z.empty());
    EXPECT_TRUE(warped(mirror(6), false).image_z.empty());
}

// An image 0.4 pixels of disparity behind the mirror is searched if two of these pixels make a pixel of the
// picture, but not if four do.
TEST(Images, ThatMoveByLessThanAQuarterOfThePicturesPixelAreNotLookedFor) {
    const auto found = [](double moves, int across) {
        const double image_z = scale / (scale / wall_z - moves);
        const Ldi ldi = warped(mirror(image_z), true, across);
        return shares(ldi, image_z, 0.05).right;
    };
    EXPECT_GT(found(0.4, 1), 0.9);
    EXPECT_EQ(found(0.4, 2), found(0.4, 1));
    EXPECT_EQ(found(0.4, 4), 0);
    EXPECT_GT(found(0.6, 4), 0.9);
    EXPECT_EQ(found(0.6, 8), 0);
}

// A mirror from the top to the bottom, 16 pixels wide, that recedes by a quarter of a pixel of disparity per
// pixel. Near its edges, too little of a patch shows the surface of a block to be compared; the depth of the image is
// continued there. A post beside its far edge, 0.9 pixels of disparity nearer, is not the mirror.
TEST(Images, ReachTheEdgesOfASteepMirrorAndEndThere) {
    constexpr double image_z = 20, recedes = 0.25;
    constexpr int left = 40, end = 56, post_begin = 58, post_end = 61;
    const double nearest = scale / wall_z + recedes * left, post = nearest - recedes * end + 0.9;
    const std::vector<View> views = five_views([&](const Imath::V2d &u) {
        return make_view(window, radius * u, [&](int i, int j) {
            const double of_post = i + 0.5 + post * u.x;
            if (of_post >= post_begin && of_post < post_end)
                return ViewPixel{.z = float(scale / post), .b = 0.5f};
            // Where the centre view shows what the pixel sees in the mirror's plane, and in its image.
            const double x = (i + 0.5 + nearest * u.x) / (1 + recedes * u.x), image = scale / image_z;
            if (x < left || x >= end) return ViewPixel{.z = 40, .g = 0.5f};
            return ViewPixel{.z = float(scale / (nearest - recedes * x)),
                             .r = waves(i + 0.5 + image * u.x, j + 0.5 - image * u.y)};
        });
    });
    const Ldi ldi = warped(views);
    ASSERT_FALSE(ldi.image_z.empty());
    int wrong = 0;
    for (int y = 12; y < window.height() - 12; ++y)
        for (int x = left; x < post_end; ++x) {
            if (x >= end && x < post_begin) continue; // other views show the post there
            const std::uint64_t i = ldi.pixel(ldi.windows.index(Imath::V2i(x, y))).front();
            wrong += !(std::abs(scale / ldi.coc_z(i) - (x < end ? scale / image_z : post)) < 0.1);
        }
    EXPECT_EQ(wrong, 0);
}

TEST(Images, NoiseMakesDepthsCoarserNotFalse) {
    const Ldi ldi = warped(mirror(6, waves, 0.1f));
    const Shares found = shares(ldi, 6, 0.05);
    EXPECT_GT(found.found, 0.9);
    EXPECT_GT(found.right, 0.8);
}

// Averaging at the depth of the image reduces noise and keeps the texture.
TEST(Images, ViewsAreAveragedWhereTheyAgree) {
    constexpr float noise = 0.1f;
    const auto error = [&](const Ldi &ldi) {
        double sum = 0;
        for (int y = 16; y < 56; ++y)
            for (int x = 16; x < 80; ++x) {
                const std::uint64_t i = ldi.pixel(ldi.windows.index(Imath::V2i(x, y))).front();
                const double seen = double(ldi.values[0][i]);
                sum += std::pow(
                    seen - double(waves(x + 0.5 + double(ldi.dx[i]), y + 0.5 + double(ldi.dy[i]))), 2);
            }
        return std::sqrt(sum / (40 * 64));
    };
    const double alone = error(warped(mirror(6, waves, noise), false)),
                 together = error(warped(mirror(6, waves, noise)));
    EXPECT_NEAR(alone, double(noise) / std::sqrt(3), 0.01);
    EXPECT_LT(together, 0.65 * alone);
    EXPECT_LT(error(warped(mirror(6))), 0.005);
}

TEST(Images, TwoViewsAreEnoughAndTheirOrderDoesNotMatter) {
    std::vector<View> views = mirror(6);
    const Ldi ldi = warped(views);
    std::swap(views[1], views[4]);
    std::swap(views[2], views[3]);
    const Ldi other = warped(views);
    EXPECT_EQ(ldi.image_z, other.image_z);
    EXPECT_EQ(ldi.values, other.values);
    EXPECT_GT(shares(warped({mirror(6)[0], mirror(6)[1]}), 6, 0.01).right, 0.9);
}

// The disparities of the images that are found if all blocks are searched; NaN: none.
std::vector<float> image_depths(const std::vector<View> &views) {
    std::vector<std::unique_ptr<ViewSamples>> samples;
    std::vector<std::unique_ptr<ViewMapping>> mappings;
    std::vector<MatchedView> matched;
    for (const View &view : views) {
        samples.push_back(std::make_unique<ViewSamples>(view, view.image.channels));
        mappings.push_back(std::make_unique<ViewMapping>(view.position, focal_px, window));
        matched.emplace_back(PlacedView{samples.back().get(), mappings.back().get()}, scale);
    }
    std::vector<std::size_t> blocks(Tiles(window.data, image_block).count());
    std::iota(blocks.begin(), blocks.end(), std::size_t(0));
    const Grid grid = window.grid();
    std::vector<float> depths(grid.size(), NAN);
    find_image_depths(ImageSweep(matched, 1), window.data, blocks,
                      [&](const Imath::Box2i &block, const ImageDepthAt &depth_at) {
                          const Grid pixels(block);
                          for (std::size_t n = 0; n < pixels.size(); ++n)
                              depths[grid.index(pixels.pixel(n))] = depth_at(pixels.pixel(n));
                      });
    return depths;
}

// A wall that covers `covers` and shows images at the disparities image(x, y).
std::vector<float> image_depths_on_wall(const std::function<double(double x, double y)> &image,
                                        const std::function<bool(double x, double y)> &covers) {
    return image_depths(five_views([&](const Imath::V2d &u) {
        TwoPlanes scene{.focal_px = focal_px};
        scene.front_z = wall_z;
        scene.front_covers = covers;
        scene.front_red = [&](double x, double y) {
            const double moves = scale / wall_z - image(x, y);
            return waves(x - moves * u.x, y + moves * u.y);
        };
        return scene.view(window, radius * u);
    }));
}
bool everywhere(double, double) { return true; }
std::size_t at(int x, int y) { return window.grid().index(Imath::V2i(x, y)); }

// The square of seven pixels fills less than a third of what lies around its middle.
TEST(Images, AFewPixelsOfAnotherDepthAreNotOne) {
    const auto image = [](double x, double y) {
        return std::abs(x - 47.5) < 3.5 && std::abs(y - 35.5) < 3.5 ? 9.0 : 4.0;
    };
    EXPECT_NEAR(image_depths_on_wall(image, everywhere)[at(47, 35)], 4, 0.4);
}

// From four pixels on beside the border of both, patches show one image alone.
TEST(Images, SideBySideKeepTheirDepths) {
    const std::vector<float> depths =
        image_depths_on_wall([](double x, double) { return x < 48 ? 4.0 : 9.0; }, everywhere);
    for (int y = 24; y < 48; ++y) {
        EXPECT_NEAR(depths[at(43, y)], 4, 0.1) << y;
        EXPECT_NEAR(depths[at(52, y)], 9, 0.1) << y;
    }
}

// An arm of a mirror, one pixel high, begins at x = 48. The image goes on along it in two steps: to the eight pixels
// beside the mirror, then to two more (pixels are continued in pairs), which are near all of these eight.
TEST(Images, GoOnFromEightPixelsOrMore) {
    const std::vector<float> depths =
        image_depths_on_wall([](double, double) { return 4.0; },
                             [](double x, double y) { return x < 48 || std::abs(y - 36.5) < 0.5; });
    EXPECT_NEAR(depths[at(57, 36)], 4, 0.1);
    EXPECT_TRUE(std::isnan(depths[at(58, 36)]));
}

} // namespace
} // namespace sparselens
