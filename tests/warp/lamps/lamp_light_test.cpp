// The light of small lamps in a picture, from views whose pixels show it exactly.
#include "base/numbers.h"
#include "dof/lens/lens_gather.h"
#include "support/views.h"
#include "warp/lamps/lamp_light.h"
#include "warp/warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace sparselens {
namespace {

constexpr int cell = 36, columns = 4, rows = 3; // lamps, each at another sub-pixel position
constexpr double radiance = 5000, focal_px = 100, radius = 1;

// Square lamps before a wall of radiance 1.
struct Lamps {
    double side;             // pixels
    double lamp_px, wall_px; // disparity
    bool
        by_chance; // a pixel has the lamp's depth as often as it shows it; else if it is more than half of it
};

// Where the centre view shows the middle of a lamp.
Imath::V2d place_of(int column, int row) {
    const int i = row * columns + column;
    return {cell * (column + 0.5) + std::fmod(0.29 * i, 1.0),
            cell * (row + 0.5) + std::fmod(0.43 * i + 0.2, 1.0)};
}

// The length of [i, i + 1] inside an interval with that middle and length.
double overlap(double middle, double length, int i) {
    const double from = std::max(middle - length / 2, double(i)), to = std::min(middle + length / 2, i + 1.0);
    return std::max(to - from, 0.0);
}

View view_of(const Lamps &lamps, const Imath::V2d &u) {
    const Imath::V2d shift = -lamps.lamp_px * Imath::V2d(u.x, -u.y);
    return make_view(windows_of_size(cell * columns, cell * rows), radius * u, [&](int x, int y) {
        double share = 0;
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column) {
                const Imath::V2d at = place_of(column, row) + shift;
                share += overlap(at.x, lamps.side, x) * overlap(at.y, lamps.side, y);
            }
        const auto view = std::uint32_t(100 + 10 * u.x + u.y);
        const double chance = unit_interval(mix_bits(view, std::uint32_t(999 * y + x)));
        const bool has_lamps_depth = share > (lamps.by_chance ? chance : 0.5);
        const float light = float(share * radiance + (1 - share));
        return ViewPixel{.z = float(radius * focal_px / (has_lamps_depth ? lamps.lamp_px : lamps.wall_px)),
                         .r = light,
                         .g = light / 2,
                         .b = light / 4};
    });
}

// The share of each lamp's light in the picture, out of focus by eight pixels.
std::vector<double> shares(const Lamps &lamps) {
    const auto views = five_views([&](const Imath::V2d &u) { return view_of(lamps, u); });
    Progress silent;
    const Ldi ldi = warp(views, {.focal_px = focal_px, .radius = radius}, silent);
    const ThinLens lens{
        .radius = radius, .focal_px = focal_px, .focus = focal_px * radius / (lamps.lamp_px + 8)};
    const Image picture = lens_gather(ldi, lens, views[0].image.windows.data, {}, silent);
    std::vector<double> result;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            double sum = -cell * cell;
            for (int y = 0; y < cell; ++y)
                for (int x = 0; x < cell; ++x)
                    sum += double(picture.at(0, cell * column + x, cell * row + y));
            result.push_back(sum / ((radiance - 1) * lamps.side * lamps.side));
        }
    return result;
}

void expect_kept(double side, double apart_px) {
    for (const bool by_chance : {true, false})
        for (const double share : shares({side, 6.37, 6.37 - apart_px, by_chance}))
            EXPECT_NEAR(share, 1, 0.01)
                << "side " << side << ", apart " << apart_px << (by_chance ? ", by chance" : "");
}

TEST(LampLight, IsKeptNearAWall) {
    for (const double apart : {0.2, 0.45})
        for (const double side : {0.5, 1.0, 2.0, 5.0}) expect_kept(side, apart);
}

TEST(LampLight, IsKeptBeforeAWall) {
    for (const double side : {0.5, 1.0, 1.5, 2.0, 3.0, 5.0}) expect_kept(side, 1.7);
}

TEST(LampLight, IsKeptBeforeAFarWall) {
    for (const double side : {0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0}) expect_kept(side, 5.3);
}

// Lamps in rows with the wall's depth in all views may be mistaken for each other: then one of five views leaves a
// fifth of the light on the wall.
TEST(LampLight, IsNeitherLostNorDoubledWhereLampsAreTakenForEachOther) {
    for (const double share : shares({0.4, 6.37, 6.37 - 5.3, false})) EXPECT_NEAR(share, 1, 0.2);
}

// Five views of a picture at one depth, parallax 0. Returns the result for an LDI that is the centre view with lamps
// half as bright.
Ldi kept(const std::function<ViewPixel(std::size_t view, int x, int y)> &pixel) {
    std::vector<View> views;
    const ViewMapping mapping({0, 0}, focal_px, windows_of_size(32, 32));
    for (std::size_t v = 0; v < 5; ++v) {
        views.push_back(
            make_view(windows_of_size(32, 32), {0, 0}, [&](int x, int y) { return pixel(v, x, y); }));
    }
    std::vector<ViewSamples> samples;
    for (const View &view : views) samples.emplace_back(view, view.image.channels);
    std::vector<PlacedView> placed;
    for (const ViewSamples &view : samples) placed.push_back({&view, &mapping});
    Ldi ldi = samples[0].as_ldi();
    for (std::size_t k = 0; k < 3; ++k)
        for (float &value : ldi.values[k]) value *= value > 4 ? 0.75f : 1;
    keep_light_of_lamps(placed, radius * focal_px, 0.5, ldi);
    return ldi;
}

bool in_lamp(int x, int y) { return (x == 10 || x == 11) && (y == 10 || y == 11); }
ViewPixel grey(float z, float light) { return {.z = z, .r = light, .g = light, .b = light}; }

// The lamp is 0.75 times as bright as it should be; its colours keep their proportion.
TEST(LampLight, IsTheMeanOfTheViews) {
    const Ldi ldi = kept([](std::size_t view, int x, int y) {
        return in_lamp(x, y) ? ViewPixel{.z = 5, .r = 1000.0f + 10 * float(view), .g = 500, .b = 0}
                             : grey(10, 1);
    });
    const std::size_t pixel = ldi.windows.index(Imath::V2i(10, 11));
    const double expected = 1500 + 10 * 2;
    EXPECT_NEAR(double(ldi.values[0][pixel]), expected * 1000 / 1500, 0.1);
    EXPECT_NEAR(double(ldi.values[1][pixel]), expected * 500 / 1500, 0.1);
    EXPECT_EQ(ldi.values[3][pixel], 1);
    EXPECT_EQ(ldi.values[0][ldi.windows.index(Imath::V2i(12, 11))], 1);
}

TEST(LampLight, IsThatOfTheViewsThatSeeAllOfIt) {
    const auto light_of = [](const std::function<bool(std::size_t view)> &hidden) {
        return kept([&](std::size_t view, int x, int y) {
                   if (x > 10 && x < 14 && hidden(view)) return grey(2, 1);
                   return in_lamp(x, y) ? grey(5, 1000) : grey(10, 1);
               })
            .values[0][32 * 10 + 10];
    };
    EXPECT_NEAR(light_of([](std::size_t view) { return view > 2; }), 1000, 0.1);
    EXPECT_EQ(light_of([](std::size_t view) { return view > 1; }), 750);  // most views do not see it
    EXPECT_EQ(light_of([](std::size_t view) { return view == 0; }), 750); // nor does the centre view
}

TEST(LampLight, StaysWhereViewsDisagree) {
    const auto light_of = [](const std::function<float(std::size_t view)> &light) {
        return kept([&](std::size_t view, int x, int y) {
                   return in_lamp(x, y) ? grey(5, light(view)) : grey(10, 1);
               })
            .values[0][32 * 10 + 10];
    };
    EXPECT_NEAR(light_of([](std::size_t view) { return view > 2 ? 300.0f : 1000.0f; }), 1000, 0.1);
    EXPECT_EQ(light_of([](std::size_t view) { return view > 1 ? 300.0f : 1000.0f; }), 750); // a gleam
    EXPECT_EQ(light_of([](std::size_t) { return 7.0f; }), 5.25); // not bright enough
}

} // namespace
} // namespace sparselens
