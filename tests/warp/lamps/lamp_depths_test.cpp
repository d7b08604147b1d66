#include "warp/lamps/lamp_depths.h"
#include "warp/warp_fixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace sparselens {
namespace {

constexpr float wall = 10, lamp = 2, post = 1.5f; // depths
constexpr double tolerance = 0.05;                // in 1 / z
constexpr double focal_px = 20;

// A wall of brightness 1; `pixel` gives the object before it, with z 0 for nothing.
View picture(const std::function<ViewPixel(int x, int y)> &pixel) {
    return make_view(windows_of_size(32, 32), {0, 0}, [&](int x, int y) {
        const ViewPixel p = pixel(x, y);
        return p.z > 0 ? p : ViewPixel{.z = wall, .r = 1, .g = 1, .b = 1};
    });
}

ViewPixel shining(float z, float light) { return {.z = z, .r = light, .g = light, .b = light}; }
constexpr ViewPixel none{.z = 0};

// The pixels whose depth changes, with the new depth.
using Moved = std::vector<std::pair<Imath::V2i, float>>;
Moved repaired(const std::vector<View> &views, const std::vector<Imath::V2d> &positions = {{0, 0}}) {
    std::vector<ViewMapping> mappings;
    std::vector<ViewSamples> samples;
    for (const View &view : views) samples.emplace_back(view, view.image.channels);
    for (const Imath::V2d &position : positions)
        mappings.emplace_back(position, focal_px, samples[0].windows);
    repair_lamp_depths(samples, mappings, tolerance);
    Moved moved;
    for (std::size_t v = 0; v < views.size(); ++v)
        for (std::size_t i = 0; i < views[v].z.size(); ++i)
            if (samples[v].z(i) != views[v].z[i])
                moved.emplace_back(samples[v].windows.pixel(i), samples[v].z(i));
    return moved;
}

bool in_square(int x, int y) { return (x == 10 || x == 11) && (y == 10 || y == 11); }

TEST(LampDepths, PixelsOfASmallLampTakeTheDepthOfThoseBeside) {
    const auto between = [](int x, int y) {
        return in_square(x, y) ? shining(x == 11 && y == 11 ? lamp : wall, 500) : none;
    };
    EXPECT_EQ(repaired({picture(between)}), (Moved{{{10, 10}, lamp}, {{11, 10}, lamp}, {{10, 11}, lamp}}));
}

// A lamp of five pixels; its corners show a tenth and 0.4 of it.
TEST(LampDepths, EdgesOfLargerLampsStay) {
    const auto larger = [](int x, int y) {
        if (x < 10 || x > 14 || y < 10 || y > 14) return none;
        if (x == 10 && y == 10) return shining(wall, 50);
        return x == 14 && y == 14 ? shining(wall, 200) : shining(lamp, 500);
    };
    EXPECT_EQ(repaired({picture(larger)}), (Moved{{{14, 14}, lamp}}));
}

TEST(LampDepths, StayWhereSomethingElseMayBeSeen) {
    const auto on_the_wall = [](int x, int y) { return in_square(x, y) ? shining(wall, 500) : none; };
    const auto beside_a_post = [](int x, int y) {
        if (in_square(x, y)) return shining(x == 11 ? post : wall, 500);
        return x == 12 ? shining(post, 1) : none;
    };
    const auto on_a_wire = [](int x, int y) {
        if (in_square(x, y)) return shining(x == 11 ? lamp : wall, 500);
        return y == 10 ? shining(lamp, 1) : none;
    };
    const auto lamps_in_line = [](int x, int y) {
        return in_square(x, y) ? shining(x == 11 ? lamp : 5, 500) : none; // both before the wall
    };
    for (const auto &scene : std::vector<std::function<ViewPixel(int, int)>>{on_the_wall, beside_a_post,
                                                                             on_a_wire, lamps_in_line})
        EXPECT_EQ(repaired({picture(scene)}), Moved{});
}

// Column 11 is a strand that covers half of each pixel of a lamp of 3 x 3; the lamp's first column has the wall's
// depth.
ViewPixel crossed(int x, int y, int strand = 11, int left = 10) {
    const bool shines = x >= left && x < left + 3 && y >= 10 && y < 13;
    if (x == strand) return shining(post, shines ? 250 : 0.5f);
    return shines ? shining(x == left ? wall : lamp, 500) : none;
}

TEST(LampDepths, AStrandMayCrossTheLamp) {
    EXPECT_EQ(repaired({picture([](int x, int y) { return crossed(x, y); })}),
              (Moved{{{10, 10}, lamp}, {{10, 11}, lamp}, {{10, 12}, lamp}}));
    const auto of_one_depth = [](int x, int y) { // the lamp is on the wall
        ViewPixel p = crossed(x, y);
        if (p.z == lamp) p.z = wall;
        return p;
    };
    EXPECT_EQ(repaired({picture(of_one_depth)}), Moved{});
}

// A second view sees the lamp beside the strand: there the lamp is three pixels farther left, the strand four.
TEST(LampDepths, NoLightOfALampStaysWithTheStrandThatCrossesIt) {
    constexpr double radius = 3 * double(lamp) / focal_px;
    const std::vector<View> views{picture([](int x, int y) { return crossed(x, y); }),
                                  make_view(windows_of_size(32, 32), {radius, 0}, [](int x, int y) {
                                      const ViewPixel p = crossed(x, y, 7, 7);
                                      return p.z > 0 ? p : ViewPixel{.z = wall, .r = 1, .g = 1, .b = 1};
                                  })};
    const Ldi ldi = warping::warped(views, {.focal_px = focal_px, .radius = radius});
    double of_strand = 0, of_lamp = 0;
    for (std::size_t i = 0; i < ldi.samples(); ++i) {
        if (ldi.z[i] < 1.75f) of_strand = std::max(of_strand, double(ldi.values[0][i]));
        if (ldi.z[i] > 1.75f && ldi.z[i] < 3) of_lamp = std::max(of_lamp, double(ldi.values[0][i]));
    }
    EXPECT_LE(of_strand, 0.6);
    EXPECT_NEAR(of_lamp, 500, 10);
}

// In a second view the lamp, which is part of the wall, is one pixel farther left, and the strand four pixels.
TEST(LampDepths, NorWithAStrandBeforeALampOfTheWall) {
    constexpr double radius = 6 / focal_px;
    const auto on_the_wall = [](int strand, int left) {
        return [=](int x, int y) {
            ViewPixel p = crossed(x, y, strand, left);
            if (p.z != post) p.z = wall;
            return p.r > 0 ? p : ViewPixel{.z = wall, .r = 1, .g = 1, .b = 1};
        };
    };
    const std::vector<View> views{make_view(windows_of_size(32, 32), {0, 0}, on_the_wall(11, 10)),
                                  make_view(windows_of_size(32, 32), {radius, 0}, on_the_wall(7, 9))};
    const Ldi ldi = warping::warped(views, {.focal_px = focal_px, .radius = radius});
    for (std::size_t i = 0; i < ldi.samples(); ++i) EXPECT_LE(ldi.z[i] < 1.75f ? ldi.values[0][i] : 0, 0.6f);
}

// The second view is from the left: objects at the depth `lamp` are one pixel farther right there.
TEST(LampDepths, OtherViewsTell) {
    const auto before = [](int x, int y) { return in_square(x, y) ? shining(lamp, 500) : none; };
    const auto flat = [](double light) {
        return [light](int x, int y) { return in_square(x - 1, y) ? shining(wall, float(light)) : none; };
    };
    const std::vector<Imath::V2d> stand{{0, 0}, {-double(lamp) / focal_px, 0}};
    EXPECT_EQ(repaired({picture(before), picture(flat(450))}, stand),
              (Moved{{{11, 10}, lamp}, {{12, 10}, lamp}, {{11, 11}, lamp}, {{12, 11}, lamp}}));
    EXPECT_EQ(repaired({picture(before), picture(flat(200))}, stand), Moved{});            // another light
    EXPECT_EQ(repaired({picture(before), picture(flat(450))}, {{0, 0}, {0, 0}}), Moved{}); // another place
}

// All views have the wall's depth. In each view the lamps are where a depth of 2 would put them, or where the wall's
// would.
TEST(LampDepths, ThePlacesInAllViewsTell) {
    constexpr double step =
        double(lamp) / focal_px; // of a view: one pixel at depth 2, a fifth of one at the wall
    const std::vector<Imath::V2d> stand{{0, 0}, {5 * step, 0}, {0, 5 * step}, {-5 * step, 0}, {0, -5 * step}};
    const auto seen = [&](double z, int shown,
                          int apart) { // lamps on a grid, if they are `apart`, in the first views
        std::vector<View> views;
        for (std::size_t v = 0; v < stand.size(); ++v)
            views.push_back(picture([&, v](int x, int y) {
                const double by = focal_px / z;
                const int left = x - 15 + int(std::lround(by * stand[v].x)),
                          top = y - 15 - int(std::lround(by * stand[v].y));
                const bool on = apart > 0 ? left % apart == 0 && top % apart == 0 : left == 0 && top == 0;
                return on && int(v) < shown ? shining(wall, 500) : none;
            }));
        return repaired(views, stand);
    };
    EXPECT_EQ(
        seen(double(lamp), 5, 0),
        (Moved{{{15, 15}, lamp}, {{10, 15}, lamp}, {{15, 20}, lamp}, {{20, 15}, lamp}, {{15, 10}, lamp}}));
    EXPECT_EQ(seen(double(lamp), 4, 0), Moved{}); // the fifth view would show it on the wall too
    EXPECT_EQ(seen(double(wall), 5, 0), Moved{});
    EXPECT_EQ(seen(double(wall), 5, 8), Moved{}); // each is where another would be, before the wall
}

} // namespace
} // namespace sparselens
