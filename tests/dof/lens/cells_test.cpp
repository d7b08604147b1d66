// Tiles gathered in cells: the interpolation compared with closed forms, pictures compared with lens points at every
// pixel.
#include "base/numbers.h"
#include "dof/gather_rows.h"
#include "dof/lens/cells.h"
#include "dof/lens/tile_plan.h"
#include "dof/methods.h"
#include "support/lens_ldi.h"
#include "support/mattes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace sparselens {
namespace {

constexpr int size = lens_tile_size;

// A tile of cells, each the mean of its pixels, whose values a function gives.
struct CellPicture {
    std::vector<float> values = std::vector<float>(size * size * 4),
                       known = std::vector<float>(size * size, 1.0f);
    TileCells cells;

    // at(x, y): the value at the middle of a pixel.
    CellPicture(const TileCells &of, const std::function<double(double x, double y)> &at) : cells(of) {
        for (int y = 0; y < of.count() * of.across; ++y)
            for (int x = 0; x < of.count() * of.across; ++x) {
                const Imath::V2i pixel = of.first * of.across + Imath::V2i(x, y);
                values[std::size_t(y / of.across * size + x / of.across) * 4] +=
                    float(at(pixel.x + 0.5, pixel.y + 0.5) / (of.across * of.across));
            }
    }
    PixelsOfCells pixels() const {
        return interpolated({values.data(), known.data(), 1, size * size * 4}, cells);
    }
    float at(int x, int y) const { return pixels().picture().value(std::size_t(y * size + x), 0); }
};

TEST(Cells, AParabolaIsKeptWhereverTheTileLies) {
    const auto parabola = [](double x, double y) {
        return 3 + 0.2 * x - 0.3 * y + 1e-4 * (x * x + y * y) + 2e-4 * x * y;
    };
    for (const int across : cell_sizes)
        for (const Imath::V2i &corner : {Imath::V2i(0, 0), Imath::V2i(-37, 5), Imath::V2i(129, -66)}) {
            const CellPicture cells(cells_of_tile(corner, across), parabola);
            const PixelsOfCells pixels = cells.pixels();
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x)
                    ASSERT_NEAR(double(pixels.picture().value(std::size_t(y * size + x), 0)),
                                parabola(corner.x + x + 0.5, corner.y + y + 0.5), 2e-4)
                        << across << " " << corner << " " << x << "," << y;
        }
}

TEST(Cells, WhatIsOneStaysOneAndNothingIsBelowNothing) {
    for (const int across : cell_sizes) {
        const TileCells cells = cells_of_tile({13, 7}, across);
        const PixelsOfCells one = CellPicture(cells, [](double, double) { return 1; }).pixels(),
                            step =
                                CellPicture(cells, [](double x, double) { return x > 40 ? 1 : 0; }).pixels();
        for (std::size_t pixel = 0; pixel < size * size; ++pixel) {
            ASSERT_EQ(one.picture().value(pixel, 0), 1);
            ASSERT_GE(step.picture().value(pixel, 0), 0);
            ASSERT_LE(step.picture().value(pixel, 0), 1);
        }
    }
}

TEST(Cells, WhatIsNotKnownSpoilsNothingBesideIt) {
    CellPicture cells(cells_of_tile({0, 0}, 4), [](double x, double) { return x < 32 ? 2 : 0; });
    for (int y = 0; y < cells.cells.count(); ++y)
        for (int x = 0; x < cells.cells.count(); ++x)
            if ((cells.cells.first.x + x) * 4 >= 32) cells.known[std::size_t(y * size + x)] = 0;
    const PixelsOfCells pixels = cells.pixels();
    for (int x = 0; x < size; ++x) {
        ASSERT_EQ(pixels.picture().is_known(std::size_t(x)), x < 32) << x;
        ASSERT_EQ(pixels.picture().value(std::size_t(x), 0), x < 32 ? 2 : 0) << x;
    }
}

// A wall behind a card with an edge through the middle; both far out of focus.
constexpr int side = 256;
const ThinLens lens{.radius = 0.6, .focal_px = 640, .focus = 5}; // CoC of infinity: 76.8 pixels

struct Scene {
    Ldi ldi;
    Progress silent;

    explicit Scene(double wall = 70, double card = -66, double light = 1, int width = side, int height = side)
        : ldi(make_ldi(windows_of_size(width, height), rgba_channels(), [=](int x, int y) {
              const auto texture = [&](std::uint32_t n) { return float(random_unit(x / 3, y / 3, n)); };
              std::vector<Sample> samples;
              if (x + y % height < height)
                  samples.push_back({depth_of(lens, card), {texture(1), texture(2), 0.5f, 1}});
              const float lamp = x == width * 25 / 32 && y == 190 ? float(light) : 0;
              samples.push_back(
                  {depth_of(lens, wall), {texture(3) + lamp, texture(4) + lamp, 0.25f + lamp, 1}});
              return samples;
          })) {}
    Image gather(const LensGatherOptions &options) {
        return lens_gather(ldi, lens, ldi.windows.data, options, silent);
    }
    // The cell size of its first tile.
    int cell_size(const LensGatherOptions &options, const ThinLens &by = lens) {
        const GatherScene scene = prepare(ldi, by, ldi.windows.data, options);
        TilePlan plan(scene, options, ldi.windows);
        const std::optional<PlannedTile> tile = plan.tile(0);
        return tile->cells ? tile->cells->across : 1;
    }
};

// Each sample shows one of `objects` objects, in stripes of 5 columns; the file has ranks for all of them.
Ldi with_objects(Ldi ldi, int objects) {
    std::vector<Channel> channels = channels_with_matte(objects / 2);
    channels.erase(channels.begin(), channels.begin() + 4); // R, G, B and A are there
    const std::size_t first = ldi.channels.size();
    ldi.channels.insert(ldi.channels.end(), channels.begin(), channels.end());
    ldi.values.resize(ldi.channels.size(), std::vector<float>(ldi.samples()));
    for (std::size_t pixel = 0; pixel < ldi.windows.pixels(); ++pixel)
        for (const std::uint64_t i : ldi.pixel(pixel)) {
            const bool wall = i + 1 == ldi.begin[pixel + 1];
            const int stripe = ldi.windows.pixel(pixel).x / 5;
            ldi.values[first][i] = hashed(std::uint32_t(1 + (stripe + (wall ? 13 : 0)) % objects));
            ldi.values[first + 1][i] = 1;
        }
    return ldi;
}

double rms(const Image &a, const Image &b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        sum += std::pow(double(a.values[i]) - double(b.values[i]), 2);
    return std::sqrt(sum / double(a.values.size()));
}

// For any size: only some pixels of the last row and column of cells are known.
TEST(Cells, AWallIsEvenUpToTheBorder) {
    for (const int across : {256, 250, 257}) {
        const Ldi wall = make_ldi(windows_of_size(across, across), rgba_channels(), [](int, int) {
            return std::vector<Sample>{{depth_of(lens, 70), {0.5f, 0.25f, 0.125f, 1}}};
        });
        Progress silent;
        const Image image = lens_gather(wall, lens, wall.windows.data, {}, silent);
        for (const float red : image.plane(0)) ASSERT_NEAR(red, 0.5f, 1e-5) << across;
        for (const float alpha : image.plane(3)) ASSERT_NEAR(alpha, 1, 1e-5) << across;
    }
}

TEST(Cells, AreAsLargeAsTheBlurAllows) {
    EXPECT_EQ(Scene(70, -65).cell_size({}), 8);
    EXPECT_EQ(Scene(60, -35).cell_size({.quality = Quality::draft}), 4);
    EXPECT_EQ(Scene(70, -65).cell_size({.quality = Quality::final}), 4);
    EXPECT_EQ(Scene(60, -3).cell_size({}), 1);
    EXPECT_EQ(Scene(70, -65).cell_size({.lens_samples = 64}), 1);
}

TEST(Cells, APostNearFocusDoesNotReachAsFarAsTheWallBehindIt) {
    Scene scene;
    scene.ldi = make_ldi(windows_of_size(side, side), rgba_channels(), [](int x, int) {
        const Sample wall{depth_of(lens, 70), {0.5f, 0.5f, 0.5f, 1}}, post{depth_of(lens, -3), {1, 1, 1, 1}};
        return x / 4 == 30 ? std::vector{post, wall} : std::vector{wall};
    });
    EXPECT_EQ(scene.cell_size({}), 4);
}

// The reference is 1024 lens points at every pixel. 4096 are nearer to the cells, so they make the difference larger.
TEST(Cells, ThePictureIsThatOfManyLensPoints) {
    for (const auto &[wall, card] :
         {std::pair(70.0, -65.0), std::pair(70.0, 40.0), std::pair(-40.0, -60.0)}) {
        Scene scene(wall, card, 1, side / 2, side / 2);
        const Image truth = scene.gather({.lens_samples = 1024});
        const Image cells = scene.gather({}), pixels = scene.gather({.lens_samples = 256});
        EXPECT_LT(rms(cells, truth), rms(pixels, truth)) << wall << " " << card;
        for (const float a : cells.plane(3)) ASSERT_NEAR(a, 1, 1e-6);
    }
}

// 40 objects, more than are gathered at once, in stripes on the card and the wall. The lens sees part of each pixel's
// light in all of them together.
TEST(Cells, CoveragesOfObjectsAddUpToAll) {
    Scene scene(70, -66, 1, side / 2, side / 2);
    scene.ldi = with_objects(std::move(scene.ldi), 40);
    ASSERT_GT(scene.cell_size({}), 1);
    const Image picture = gather_mattes(scene.ldi, lens, scene.ldi.windows.data, {.looks = {}}, scene.silent);
    const std::vector<Matte> mattes = find_mattes(picture.channels);
    for (std::size_t i = 0; i < picture.windows.pixels(); ++i) {
        double sum = 0;
        for (const Matte::Rank &rank : mattes[0].ranks) {
            const double coverage = double(picture.plane(rank.coverage)[i]);
            ASSERT_GE(coverage, 0);
            sum += coverage;
        }
        ASSERT_NEAR(sum, 1, 1e-5) << picture.windows.pixel(i);
    }
}

// Any lens and samples: no farther from 1024 lens points at every pixel than the number of points a tile would have.
struct Beside {
    const char *name;
    LensLooks looks = {};
    std::function<void(Ldi &)> change = [](Ldi &) {};
    double pixel_aspect = 1;
    int width = 90, height = 60;
};
const std::vector<Beside> beside_cells{
    {"cat's eyes", {.cat_eye = 1}},
    {"curvature", {.field_curvature = 0.02}},
    {"blades and a squeeze", {.aperture = {.blades = 5, .squeeze = 1.5}}},
    {"a bent and tilted plane of focus", {.field_curvature = 0.01, .tilt = {0.01, -0.02}}},
    {"pixels twice as wide as high", {}, [](Ldi &) {}, 2},
    {"cat's eyes in a small odd frame", {.cat_eye = 1}, [](Ldi &) {}, 1, 61, 47},
    {"colour fringes", {.chromatic_coc = {3, 0, -3}}},
    {"partial coverage",
     {},
     [](Ldi &ldi) {
         for (std::size_t i = 0; i < ldi.samples(); ++i)
             for (std::vector<float> &channel : ldi.values)
                 if (float(circle_of_confusion(lens, double(ldi.z[i]))) < 0) channel[i] *= 0.6f;
     }},
    {"alpha of each channel",
     {},
     [](Ldi &ldi) {
         ldi.channels = {{"R"}, {"G"}, {"B"}, {"A"}, {"AR"}, {"AG"}, {"AB"}};
         ldi.values.resize(7, ldi.values[3]);
         for (std::size_t i = 0; i < ldi.samples(); ++i)
             if (circle_of_confusion(lens, double(ldi.z[i])) < 0)
                 for (std::size_t k = 0; k < 3; ++k) {
                     const float cover = 0.4f + 0.2f * float(k);
                     ldi.values[k][i] *= cover, ldi.values[4 + k][i] = cover, ldi.values[3][i] = 0.6f;
                 }
     }},
    {"images of mirrors",
     {},
     [](Ldi &ldi) {
         ldi.image_z = ldi.z;
         for (float &z : ldi.image_z) // the wall's
             if (circle_of_confusion(lens, double(z)) > 0) z = float(depth_of(lens, 50));
     }},
    {"solids",
     {},
     [](Ldi &ldi) {
         ldi.solid.assign(ldi.samples(), 0);
         for (std::size_t i = 0; i < ldi.samples(); i += 2) ldi.solid[i] = 0.1f / ldi.z[i];
     }},
};

TEST(Cells, ThePictureIsThatOfManyLensPointsWhateverTheLensAndTheSamplesAre) {
    for (const Beside &beside : beside_cells) {
        const char *name = beside.name;
        const LensLooks &looks = beside.looks;
        Scene scene(70, -62, 1, beside.width, beside.height);
        beside.change(scene.ldi);
        ThinLens by = lens;
        by.pixel_aspect = beside.pixel_aspect;
        scene.ldi.windows.pixel_aspect = float(beside.pixel_aspect);
        ASSERT_GT(scene.cell_size({.looks = looks}, by), 1) << name;
        const auto picture = [&](int points) {
            PictureOptions options;
            options.gather.lens = {.lens_samples = points, .looks = looks};
            const Imath::Box2i &window = scene.ldi.windows.data;
            return gather_picture(scene.ldi, by, window, window, options, scene.silent);
        };
        const Image truth = picture(1024);
        EXPECT_LT(rms(picture(0), truth), rms(picture(256), truth)) << name;
    }
}

// Its disc has sharp edges, and the card before it cuts the disc. The disc is spread exactly: with 256 and 4096 lens
// points it differs by 5e-4 of the peak.
TEST(Cells, ALampKeepsItsDisc) {
    for (const double card : {-66.0, 40.0}) {
        Scene scene(70, card, 4000), without(70, card, 0);
        const auto disc = [&](const LensGatherOptions &by) {
            Image lit = scene.gather(by), dark = without.gather(by);
            std::ranges::transform(lit.values, dark.values, lit.values.begin(), std::minus());
            return lit;
        };
        const Image truth = disc({.lens_samples = 256}), cells = disc({});
        double light = 0, all = 0;
        for (const float v : cells.plane(0)) light += double(v);
        for (const float v : truth.plane(0)) all += double(v);
        EXPECT_NEAR(light / all, 1, 0.01) << card;
        const double peak = double(std::ranges::max(truth.plane(0)));
        EXPECT_LT(rms(cells, truth), 0.03 * peak) << card;
    }
}

TEST(Cells, AreTheSameBitsByAnyThreads) {
    Scene scene;
    const Image several = scene.gather({});
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(scene.gather({}).values, several.values);
}

// A band lacks rows below or above, and the blur is wider than the rows prepared beside the visible ones.
TEST(Cells, AreTheSameBitsInBands) {
    constexpr int width = 72, height = 900, gathered = 2 * lens_tile_size;
    Scene scene(-125, -140, 4000, width, height);
    ASSERT_GT(scene.cell_size({}), 1);
    PackedRows rows(scene.ldi.windows);
    rows.append(scene.ldi);
    const RowReach reach = reach_of(rows, lens, {});
    EXPECT_LT(gathered + reach.seen + reach.prepared, height); // otherwise a band has all rows
    EXPECT_GT(125, reach.prepared + 16);                       // a block beside
    for (const int first : {0, height - gathered}) {
        const Imath::Box2i window({0, first}, {width - 1, first + gathered - 1});
        PictureOptions options;
        const Image whole = gather_picture(scene.ldi, lens, window, window, options, scene.silent);
        const Image banded = gather_rows(rows, lens, window, window, options, {0, true}, scene.silent);
        EXPECT_TRUE(banded.values == whole.values) << first;
    }
}

} // namespace
} // namespace sparselens
