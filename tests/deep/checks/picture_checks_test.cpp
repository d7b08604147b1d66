// Mistakes that pictures show, tested on pictures given by formulas.
#include "deep/checks/picture_checks.h"
#include "deep/checks/view_warnings.h"
#include "support/views.h"
#include "view/depth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace sparselens {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();

float srgb(float v) { return v <= 0.0031308f ? v * 12.92f : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f; }

// Stripes 8 pixels wide whose edges are anywhere within pixels. Edge pixels mix the colours of both sides.
View stripes(const std::function<float(float)> &stored) {
    return make_view(windows_of_size(128, 64), {0, 0}, [&](int x, int y) {
        const double at = x + 0.37 * y, place = std::fmod(at, 16);
        const double share = place < 8 ? std::clamp(place, 0.0, 1.0) : std::clamp(9 - place, 0.0, 1.0);
        const auto mixed = [&](double a, double b) { return stored(float(a + (b - a) * share)); };
        return ViewPixel{.z = 3, .r = mixed(0.8, 0.05), .g = mixed(0.1, 0.6), .b = mixed(0.02, 0.3)};
    });
}

TEST(EncodingCheck, LightMixesAtEdgesAndCodesDoNot) {
    const EdgeMixing light = mixing_at_edges(stripes([](float v) { return v; }));
    EXPECT_GT(light.pixels, 500u);
    EXPECT_EQ(light.light, light.pixels);
    EXPECT_EQ(light.encoded, 0u);
    EXPECT_FALSE(looks_encoded(light));
    const EdgeMixing codes = mixing_at_edges(stripes(srgb));
    EXPECT_EQ(codes.encoded, codes.pixels);
    EXPECT_EQ(codes.light, 0u);
    EXPECT_TRUE(looks_encoded(codes));
}

// Stripes rendered with one sample per pixel. Each third stripe is a pixel wide, with a colour between its two
// neighbours that is far from the line between them, on the side of the curve.
TEST(EncodingCheck, WhatNoPixelMixesSaysNothing) {
    const View view = make_view(windows_of_size(128, 64), {0, 0}, [](int x, int y) {
        const int place = (x + y) % 17;
        if (place == 8 || place == 16) return ViewPixel{.z = 3, .r = 0.6f, .g = 0.55f, .b = 0.2f};
        return place < 8 ? ViewPixel{.z = 3, .r = 0.8f, .g = 0.1f, .b = 0.02f}
                         : ViewPixel{.z = 3, .r = 0.05f, .g = 0.6f, .b = 0.3f};
    });
    const EdgeMixing mixing = mixing_at_edges(view);
    EXPECT_GT(mixing.pixels, 500u);
    EXPECT_EQ(mixing.light + mixing.encoded + mixing.beyond, 0u);
    EXPECT_FALSE(looks_encoded(mixing));
}

TEST(EncodingCheck, FewMixturesSayNothing) {
    EXPECT_TRUE(looks_encoded({.pixels = 40, .light = 2, .encoded = 25, .beyond = 2}));
    EXPECT_FALSE(looks_encoded({.pixels = 40, .light = 0, .encoded = 8, .beyond = 0})) << "chance";
    EXPECT_FALSE(looks_encoded({.pixels = 1000, .light = 0, .encoded = 90, .beyond = 0}))
        << "of all, too few";
    EXPECT_FALSE(looks_encoded({.pixels = 1000, .light = 300, .encoded = 350, .beyond = 0})) << "as light";
    EXPECT_FALSE(looks_encoded({.pixels = 1000, .light = 0, .encoded = 300, .beyond = 280})) << "as beyond";
}

TEST(EncodingCheck, GreysSayNothing) {
    View view = stripes(srgb);
    for (const std::size_t k : {1u, 2u}) std::ranges::copy(view.image.plane(0), view.image.plane(k).begin());
    EXPECT_FALSE(looks_encoded(mixing_at_edges(view)));
}

// A floor and an oblique wall, with depths encoded by `stored`.
View floor_and_wall(const std::function<double(double z)> &stored) {
    return make_view(windows_of_size(120, 100), {0, 0}, [&](int x, int y) {
        const double z = y > 55 ? 40.0 / (y - 50) : 1 / (0.1 + 0.001 * x);
        return ViewPixel{.z = float(stored(z))};
    });
}

TEST(DepthCheck, PlanesAreLinearInInverseDepth) {
    const DepthSlopes planar = slopes_of_depth(floor_and_wall([](double z) { return z; }));
    EXPECT_GT(planar.slopes, 1000u);
    EXPECT_GT(planar.planar, 0.95);
    EXPECT_LT(planar.inverse, 0.01);
    EXPECT_FALSE(looks_inverse(planar));
    const DepthRange range{0.5, 100};
    for (const std::function<double(double)> &stored :
         {std::function([](double z) { return 1 / z; }), std::function([&](double z) {
              return (1 / range.near - 1 / z) / (1 / range.near - 1 / range.far);
          })}) {
        const DepthSlopes inverse = slopes_of_depth(floor_and_wall(stored));
        EXPECT_GT(inverse.inverse, 0.95);
        EXPECT_TRUE(looks_inverse(inverse));
    }
}

TEST(DepthCheck, WhatFacesTheCameraSaysNothing) {
    const View wall = make_view(windows_of_size(120, 100), {0, 0},
                                [](int x, int) { return ViewPixel{.z = x < 60 ? 2.0f : inf}; });
    EXPECT_EQ(slopes_of_depth(wall).slopes, 0u);
    EXPECT_FALSE(looks_inverse(slopes_of_depth(wall)));
}

// R F = 40, focused at 10: a CoC of -6 at 4, and of 2 at 20.
constexpr ThinLens lens{.radius = 0.4, .focal_px = 100, .focus = 10};

// A bright card before a dark wall, whose edge is `width` pixels wide.
View card_of(double width) {
    return make_view(windows_of_size(120, 100), {0, 0}, [&](int x, int) {
        const double share = std::clamp((x + 0.5 - 60) / width + 0.5, 0.0, 1.0);
        const auto mixed = [&](double a, double b) { return float(a + (b - a) * share); };
        return ViewPixel{
            .z = x < 60 ? 4.0f : 20.0f, .r = mixed(0.9, 0.1), .g = mixed(0.2, 0.3), .b = mixed(0.1, 0.6)};
    });
}

TEST(BlurCheck, EdgesOutOfFocusAreSharpThroughAPinhole) {
    const EdgeSharpness sharp = sharpness_of_edges(card_of(1), lens);
    EXPECT_GE(sharp.edges, 200u);
    EXPECT_NEAR(sharp.steepest, 1, 1e-5);
    EXPECT_FALSE(looks_defocused(sharp));
    const EdgeSharpness blurred = sharpness_of_edges(card_of(12), lens); // twice the CoC
    EXPECT_NEAR(blurred.steepest, 3.0 / 12, 0.01);
    EXPECT_TRUE(looks_defocused(blurred));
}

// The card has fur: its edge is soft, and its strands are as sharp as pixels.
TEST(BlurCheck, WhatIsFineOutOfFocusIsNoBlur) {
    const View soft = card_of(12);
    View fur = soft;
    const Windows &w = fur.image.windows;
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 46; ++x) // the sides of edges are even from 46 on
            for (std::size_t k = 0; k < 3; ++k)
                if ((x + y / 8) % 4 == 0) fur.image.at(k, w.data.min.x + x, w.data.min.y + y) *= 0.5f;
    EXPECT_TRUE(looks_defocused(sharpness_of_edges(soft, lens)));
    const EdgeSharpness sharpness = sharpness_of_edges(fur, lens);
    EXPECT_NEAR(sharpness.steepest, 3.0 / 12, 0.01);
    EXPECT_GT(sharpness.fine, 0.2);
    EXPECT_FALSE(looks_defocused(sharpness));
}

// The wall lies in focus, and its texture is as smooth as the edge: all of the picture was filtered.
TEST(BlurCheck, WhatIsAsSoftInFocusIsNoBlur) {
    const ThinLens on_the_wall{.radius = 0.4, .focal_px = 60, .focus = 20}; // a CoC of -4.8 on the card
    const auto card_before = [](double period) {                            // of the wall's texture
        View view = card_of(12);
        const Windows &w = view.image.windows;
        for (int y = 0; y < 100; ++y)
            for (int x = 80; x < 120; ++x)
                for (std::size_t k = 0; k < 3; ++k)
                    view.image.at(k, w.data.min.x + x, w.data.min.y + y) *=
                        float(1 + 0.3 * std::sin(2 * std::numbers::pi * x / period));
        return view;
    };
    const EdgeSharpness sharp = sharpness_of_edges(card_before(6), on_the_wall),
                        soft = sharpness_of_edges(card_before(60), on_the_wall);
    EXPECT_GT(sharp.fine_in_focus, 0.2);
    EXPECT_TRUE(looks_defocused(sharp));
    EXPECT_LT(soft.fine_in_focus, 1.2 * soft.fine);
    EXPECT_FALSE(looks_defocused(soft));
}

TEST(BlurCheck, EdgesInFocusMayBeAnything) {
    const ThinLens on_the_card{.radius = 0.4, .focal_px = 100, .focus = 4};
    EXPECT_EQ(sharpness_of_edges(card_of(12), on_the_card).edges, 0u);
    EXPECT_EQ(sharpness_of_edges(card_of(12), {.radius = 0}).edges, 0u);
}

TEST(LensCheck, AUnitTooSmallBlursNothing) {
    const View view = card_of(1);
    EXPECT_NEAR(largest_circle_of_confusion(view.z, lens), 6, 1e-9);
    EXPECT_FALSE(blurs_nothing(6, lens));
    const ThinLens centimetres{.radius = 0.004, .focal_px = 100, .focus = 10};
    EXPECT_NEAR(largest_circle_of_confusion(view.z, centimetres), 0.06, 1e-9);
    EXPECT_TRUE(blurs_nothing(0.06, centimetres));
    EXPECT_FALSE(blurs_nothing(0, {.radius = 0})) << "is meant to";
}

View at(const Imath::V2d &position) {
    View view = card_of(1);
    view.position = position;
    view.name = "view";
    return view;
}

TEST(LensCheck, AViewBeyondThreeRadii) {
    const std::vector<View> views{at({0, 0}), at({0.4, 0}), at({1.19, 0}), at({0, -1.21}), at({400, 0})};
    EXPECT_EQ(views_beyond_lens(referring_to(views), 0.4), (std::vector<std::size_t>{3, 4}));
    EXPECT_TRUE(views_beyond_lens(referring_to(views), 0).empty()) << "unknown";
}

// A disc whose coverage falls to 0 over 20 pixels. `depth_of` gives the depth of a coverage.
View soft_disc(const std::function<float(float coverage)> &depth_of) {
    View view{.name = "view",
              .image = Image(windows_of_size(100, 100), rgba_channels()),
              .z = std::vector<float>(10'000, std::numeric_limits<float>::infinity())};
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 100; ++x) {
            const double from_middle = std::hypot(x - 50, y - 50);
            const auto a = float(std::clamp((40 - from_middle) / 20, 0.0, 1.0));
            const float light = (x / 4 + y / 4) % 2 == 0 ? 0.4f : 0.8f;
            for (std::size_t k = 0; k < 4; ++k) view.image.at(k, x, y) = k < 3 ? a * light : a;
            if (a > 0) view.z[std::size_t(100 * y + x)] = depth_of(a);
        }
    return view;
}

TEST(EdgeDepths, AreThoseOfTheSurfaceOrFollowCoverage) {
    const View own = soft_disc([](float) { return 3.0f; }),
               multiplied = soft_disc([](float a) { return 3 * a; }),
               averaged = soft_disc([](float a) { return 3 * a + 1000 * (1 - a); });
    EXPECT_GT(depths_at_edges(own).pixels, 1000u);
    for (const View *view : {&own, &averaged}) EXPECT_FALSE(looks_multiplied(depths_at_edges(*view)));
    for (const View *view : {&own, &multiplied}) EXPECT_FALSE(looks_averaged(depths_at_edges(*view)));
    EXPECT_TRUE(looks_multiplied(depths_at_edges(multiplied)));
    EXPECT_TRUE(looks_averaged(depths_at_edges(averaged)));
    // A surface that recedes from the edge of the disc on.
    EXPECT_FALSE(looks_averaged(depths_at_edges(soft_disc([](float a) { return 3 + (1 - a); }))));
}

TEST(LacksCoverage, WhereAIsZeroEverywhere) {
    View view = soft_disc([](float) { return 3.0f; });
    EXPECT_FALSE(lacks_coverage(view));
    std::ranges::fill(view.image.plane(3), 0.0f);
    EXPECT_TRUE(lacks_coverage(view));
    std::ranges::fill(view.image.values, 0.0f);
    EXPECT_FALSE(lacks_coverage(view)) << "shows nothing";
}

std::string said_of(const View &view, const ViewFacts &facts) {
    std::string all;
    for (const std::string &warning : picture_warnings(view, facts)) all += warning + "\n";
    return all;
}

Camera camera_with(const ThinLens &of, const View &view) {
    Camera camera;
    camera.focal_length_mm = of.focal_px;
    camera.sensor_width_mm = view.image.windows.display_width();
    camera.lens_radius = of.radius;
    camera.focus_distance = of.focus;
    return camera;
}

TEST(ViewWarnings, EachSaysWhatToDo) {
    const ThinLens tiny{.radius = 0.004, .focal_px = 100, .focus = 10};
    EXPECT_EQ(said_of(card_of(1), {.camera = camera_with(lens, card_of(1))}), "");
    EXPECT_NE(said_of(card_of(1), {.camera = camera_with(tiny, card_of(1))}).find("0.06 pixels"),
              std::string::npos);
    EXPECT_NE(said_of(card_of(1), {.camera = camera_with(tiny, card_of(1))}).find("`scene_unit=0.01`"),
              std::string::npos);
    EXPECT_NE(
        said_of(card_of(12), {.camera = camera_with(lens, card_of(12))}).find("switch depth of field off"),
        std::string::npos);
    EXPECT_NE(said_of(stripes(srgb), {}).find("`colorspace=sRGB`"), std::string::npos);
    EXPECT_NE(said_of(stripes([](float v) { return v; }), {.depth_filtered = true}).find("without a filter"),
              std::string::npos);
    const View inverse = floor_and_wall([](double z) { return 1 / z; });
    EXPECT_NE(said_of(inverse, {}).find("`depth=hyperbolic`"), std::string::npos);
    EXPECT_EQ(said_of(inverse, {.depth = DepthMeaning::distance}), "") << "as asked for";
    const std::vector<View> views{at({0, 0}), at({400, 0}), at({-400, 0})};
    const auto said = view_warnings(
        views, {.camera = camera_with({.radius = 0.4, .focal_px = 100, .focus = lens.focus}, views[0])});
    ASSERT_FALSE(said.empty());
    EXPECT_EQ(said[0].find(
                  "view and 1 more: stands 400 from the centre, 1000 times the radius of the lens, 0.4: in "
                  "millimetres?"),
              0u)
        << said[0];
    EXPECT_EQ(said.size(), 3u) << "and that they are the same picture";
}

} // namespace
} // namespace sparselens
