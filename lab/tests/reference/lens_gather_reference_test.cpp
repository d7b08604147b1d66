// Compares the fast lens gather with the slow one, point for point. The channels have no colour names: highlights and
// sharpening, which the slow one lacks, have their own tests.
#include "dof/lens/lens_gather.h"
#include "lab/tests/support/reference_picture.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sparselens {
namespace {

struct Case {
    const char *name;
    Imath::Box2i data, window;
    double aspect = 1;
    double partial = 0.5; // share of samples with partial coverage
    int most_samples = 3;
    double smallest_coc = 0; // pixels
    int lens_samples = 16;
    bool colour = false; // channels R, G, B: no highlights, and nothing is near focus
    double glowing = 0;  // share of samples with light but no coverage
    LensLooks looks = {};
    double images = 0; // share of samples with an image at another depth
    double solids = 0; // share of solid samples, up to two pixels of disparity
};

// Weights that differ for R, G and B.
std::shared_ptr<const AperturePicture> tinted() {
    return std::make_shared<AperturePicture>(AperturePicture{2, 2, {1, 2, 3, 3, 1, 1, 0.5f, 1, 2, 1, 1, 1}});
}

void PrintTo(const Case &c, std::ostream *out) { *out << c.name; }

ThinLens lens_of(const Case &c) {
    return {.radius = 0.06, .focal_px = 640, .focus = 5, .pixel_aspect = c.aspect};
}

// CoC -7 to 7 px, all depths different.
Ldi random_layers(const Case &c, const ThinLens &lens) {
    Windows windows{c.window, c.data, float(c.aspect)};
    std::vector<Channel> channels{{"Y"}, {"A"}, {"extra.Y", PixelType::float32}};
    if (c.colour) channels = rgba_channels();
    if (c.looks != LensLooks())
        channels = {{"R"}, {"A"}, {"extra.B"}, {"data"}}; // without G nothing is sharpened
    return make_ldi(windows, channels, [&](int x, int y) {
        std::vector<Sample> samples;
        const int count = int((c.most_samples + 1) * random_unit(x, y, 1));
        for (int i = 0; i < count; ++i) {
            const auto random = [&](std::uint32_t k) {
                return random_unit(x, y, 100 * k + 7 + std::uint32_t(i));
            };
            const double size = c.smallest_coc + (7 - c.smallest_coc) * random(1);
            const bool glows = random(11) < c.glowing;
            const float alpha = glows ? 0 : random(2) < c.partial ? 0.1f + 0.5f * float(random(3)) : 1;
            std::vector<float> values;
            for (std::uint32_t k = 0; k < channels.size(); ++k)
                values.push_back(channels[k].name == "A"
                                     ? alpha
                                     : (glows ? 0.2f : alpha) * float(0.5 + 0.5 * random(4 + k)));
            samples.push_back({depth_of(lens, random(8) < 0.5 ? size : -size), values, float(random(9) - 0.5),
                               float(random(10) - 0.5)});
            if (random(12) < c.images) samples.back().image_z = depth_of(lens, 14 * random(13) - 7);
            if (random(14) < c.solids) samples.back().solid = 2 * random(15) / (lens.radius * lens.focal_px);
        }
        std::sort(samples.begin(), samples.end(), [](const auto &a, const auto &b) { return a.z < b.z; });
        return samples;
    });
}

class LensGatherReference : public testing::TestWithParam<Case> {};

TEST_P(LensGatherReference, IsTheLensGather) {
    const Case &c = GetParam();
    const ThinLens lens = lens_of(c);
    const Ldi ldi = random_layers(c, lens);
    Progress silent;
    const LensGatherOptions options{.lens_samples = c.lens_samples, .looks = c.looks};
    const Image image = lens_gather(ldi, lens, c.window, options, silent);
    const Aperture aperture(c.looks.aperture);
    const CatEye cat_eye(aperture, c.looks, picture_frame(ldi.windows, c.looks));
    const auto points = lens_samples(aperture, std::size_t(c.lens_samples), c.aspect);
    expect_within(image, lens_gather_reference(ldi, lens, c.window, points, nullptr,
                                               cat_eye.cuts() ? &cat_eye : nullptr));
}

const Imath::Box2i look_window({0, 0}, {69, 29});

Case looks(const char *name, const LensLooks &of, double solids = 0) {
    Case c{name, look_window, look_window, 1, 0.4};
    c.looks = of;
    c.solids = solids;
    return c;
}

constexpr auto box = [](int x0, int y0, int x1, int y1) { return Imath::Box2i({x0, y0}, {x1, y1}); };

const Case cases[] = {
    {"Opaque", box(0, 0, 75, 15), box(0, 0, 75, 15), 1, 0},
    {"Partial", box(0, 0, 75, 15), box(0, 0, 75, 15), 1, 0.7},
    {"AllPartial", box(0, 0, 15, 75), box(0, 0, 15, 75), 1, 1, 5},
    {"PixelsTwiceAsHigh", box(0, 0, 20, 69), box(0, 0, 20, 69), 2},
    {"NegativeOrigin", box(-70, -9, 4, 6), box(-70, -9, 4, 6)},
    {"WindowWithinTheData", box(-20, -12, 60, 15), box(-3, -4, 50, 9)},
    {"FarFromFocus", box(0, 0, 40, 40), box(0, 0, 40, 40), 1, 0.3, 3, 4.5, 32, true},
    {"OneLensPoint", box(0, 0, 70, 30), box(0, 0, 70, 30), 1, 0.5, 3, 0, 1},
    {"Glowing", box(0, 0, 20, 70), box(0, 0, 20, 70), 1, 0.3, 4, 0, 16, false, 0.5},
    {"Images", box(0, 0, 40, 40), box(0, 0, 40, 40), 1, 0.3, 3, 0, 16, false, 0, {}, 0.4},
    {"Solids", box(0, 0, 40, 40), box(0, 0, 40, 40), 1, 0.2, 2, 0, 16, false, 0, {}, 0, 0.6},
    {"SolidMirrors", box(0, 0, 40, 40), box(2, 1, 37, 30), 1, 0.5, 3, 0, 16, false, 0, {}, 0.3, 0.6},
    {"ManyLensPoints", box(0, 0, 20, 20), box(0, 0, 20, 20), 1, 0.5, 3, 0, 200},
    looks("Blades", {.aperture = {.blades = 5, .rotation = 10, .squeeze = 1.5}}),
    looks("Rings", {.aperture = {.spherical = 0.8}}),
    looks("ColouredRings", {.aperture = {.spherical = {-0.5, 0.2, 0.9}}}),
    looks("ColouredRingsOfACatEye", {.aperture = {.spherical = {-0.5, 0.2, 0.9}}, .cat_eye = 0.7}),
    looks("RingedBlades", {.aperture = {.blades = 3, .spherical = -1}}),
    looks("RingedSolids", {.aperture = {.spherical = 0.8}}, 0.6),
    looks("ColouredAperture", {.aperture = {.picture = tinted()}}),
    looks("CatEye", {.cat_eye = 1}),
    looks("CatEyeOfBlades", {.aperture = {.blades = 6, .squeeze = 2, .spherical = 0.5}, .cat_eye = 0.7}),
    looks("DarkeningCatEye", {.cat_eye = 1.2, .cat_eye_darkening = true}),
};

INSTANTIATE_TEST_SUITE_P(Random, LensGatherReference, testing::ValuesIn(cases),
                         [](const auto &c) { return c.param.name; });

// Tests the slow gather itself against known answers. `seen` reads the first row:
float seen(const ReferencePicture &picture, std::size_t channel, int x) {
    return float(picture.at(channel, x, 0).value);
}

TEST(LensGatherReferenceItself, OneLensPointSeesThePinholePictureShifted) {
    const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};
    const LensSample right{1, 0, 0, 0, 1};
    const Ldi ldi = make_ldi(windows_of_size(9, 1), {{"Y"}}, [&](int x, int) {
        return std::vector<Sample>{{depth_of(lens, x == 4 ? -3 : 2), {float(x)}}};
    });
    const ReferencePicture image = lens_gather_reference(ldi, lens, ldi.windows.data, std::span(&right, 1));
    // Pixels of CoC 2 move two to the right, the one in front three to the left; behind it the mean of its neighbours
    // shows. Pixels from beyond the picture are unknown: the pixel keeps its value.
    const float expected[] = {0, 4, 0, 1, 2, 3, 4, 5, 6};
    for (int x = 0; x < 9; ++x) EXPECT_EQ(seen(image, 0, x), expected[x]) << x;
}

// A mirror of CoC 1 whose image has CoC 3, and a bar of CoC 0 before it, seen through the right rim of the lens.
TEST(LensGatherReferenceItself, ImagesMoveByTheirDepthAndHideByTheMirrors) {
    const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};
    const LensSample right{1, 0, 0, 0, 1};
    const auto gather = [&](double bar_coc) {
        const Ldi ldi = make_ldi(windows_of_size(12, 1), {{"Y"}}, [&](int x, int) {
            if (x == 5) return std::vector<Sample>{{depth_of(lens, bar_coc), {100}}};
            Sample mirror{depth_of(lens, 1), {float(x)}};
            mirror.image_z = depth_of(lens, 3);
            return std::vector<Sample>{mirror};
        });
        return lens_gather_reference(ldi, lens, ldi.windows.data, std::span(&right, 1));
    };
    const ReferencePicture image = gather(0);
    for (const int x : {4, 5, 7, 9, 10, 11}) EXPECT_EQ(seen(image, 0, x), x == 5 ? 100 : float(x - 3)) << x;
    EXPECT_EQ(seen(image, 0, 6),
              5); // the mirror behind the bar, which no view saw: the mean of its neighbours
    EXPECT_EQ(seen(gather(2), 0, 7), 4); // nearer than its image, but behind the mirror
}

TEST(LensGatherReferenceItself, WhatLiesBehindCoverageCountsByWhatIsLeft) {
    const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};
    const LensSample middle{0, 0, 0, 0, 1};
    const auto gather = [&](const std::vector<Sample> &samples) {
        const Ldi ldi = make_ldi(windows_of_size(2, 1), {{"Y"}, {"A"}},
                                 [&](int x, int) { return x == 0 ? samples : std::vector<Sample>{}; });
        return lens_gather_reference(ldi, lens, ldi.windows.data, std::span(&middle, 1));
    };
    const ReferencePicture opaque = gather({{2, {0.3f, 0.5f}}, {4, {0.8f, 1}}, {6, {9, 1}}});
    EXPECT_FLOAT_EQ(seen(opaque, 0, 0), 0.3f + 0.5f * 0.8f);
    EXPECT_FLOAT_EQ(seen(opaque, 1, 0), 1);
    const ReferencePicture clear = gather({{2, {0.3f, 0.5f}}});
    EXPECT_FLOAT_EQ(seen(clear, 0, 0), 0.3f);
    EXPECT_FLOAT_EQ(seen(clear, 1, 0), 0.5f);
    EXPECT_EQ(seen(clear, 1, 1), 0);
}

TEST(LensGatherReferenceItself, UnknownIsLeftOut) {
    const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};
    // The middle of the lens sees the sample that covers the pixel. The point to the left, with three times the weight,
    // sees it moved away, and the glass in focus before it in the same position.
    const LensSample points[] = {{0, 0, 0, 0, 1}, {-1, 0, 0, 0, 3}};
    const auto gather = [&](bool glass) {
        const Ldi ldi = make_ldi(windows_of_size(1, 1), {{"Y"}, {"A"}}, [&](int, int) {
            std::vector<Sample> samples{{depth_of(lens, 2), {0.9f, 1}}};
            if (glass) samples.insert(samples.begin(), {5, {0.2f, 0.5f}});
            return samples;
        });
        return lens_gather_reference(ldi, lens, ldi.windows.data, points);
    };
    EXPECT_FLOAT_EQ(seen(gather(false), 0, 0), 0.9f);
    EXPECT_FLOAT_EQ(seen(gather(false), 1, 0), 1);
    EXPECT_FLOAT_EQ(seen(gather(true), 0, 0), (0.2f + 0.5f * 0.9f + 3 * 0.2f) / (1 + 3 * 0.5f));
    EXPECT_FLOAT_EQ(seen(gather(true), 1, 0), 1);
}

// A plane whose neighbours part by less than half a pixel has no crack, and a gap in the picture is not a crack.
TEST(LensGatherReferenceItself, CracksAreClosedAndGapsAreNot) {
    const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};
    const LensSample right{1, 0, 0, 0, 1};
    const auto gather = [&](const std::vector<double> &cocs) {
        const Ldi ldi = make_ldi(windows_of_size(int(cocs.size()), 1), {{"Y"}}, [&](int x, int) {
            return std::vector<Sample>{{depth_of(lens, cocs[std::size_t(x)]), {float(x)}}};
        });
        return lens_gather_reference(ldi, lens, ldi.windows.data, std::span(&right, 1));
    };
    // Pixels 1 and 2 part at pixel 2, which shows the farther of them.
    const ReferencePicture crack = gather({0.2, 0.4, 0.7, 0.8, 1.1});
    EXPECT_EQ(seen(crack, 0, 1), 1);
    EXPECT_EQ(seen(crack, 0, 2), 2);
    EXPECT_EQ(seen(crack, 0, 3), 2);
    // Behind a gap one pixel wide, pixel 2, the background differs from its neighbours. Moved away, it leaves a filler
    // that the neighbours hide, and the pixel keeps its value.
    EXPECT_EQ(seen(gather({0, 0, 6, 0, 0}), 0, 2), 2);
}

} // namespace
} // namespace sparselens
