// The kernel of the lens gather compared with the CPU.
#include "deep/tidy.h"
#include "dof/lens/lens_gather.h"
#include "gpu/gpu_fixture.h"
#include "lens/lens_samples.h"
#include "support/lens_ldi.h"

#include <algorithm>
#include <memory>

namespace sparselens::gpu {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};

// Random surfaces without highlights.
Ldi surfaces(int width, int height, bool opaque, std::uint32_t stream) {
    Ldi ldi = random_surfaces(windows_of_size(width, height), lens, opaque, stream);
    for (std::vector<float> &values : ldi.values)
        for (float &value : values) value = std::min(value, 1.0f);
    return ldi;
}

Image gather(const Ldi &ldi, const LensGatherOptions &options, const ThinLens &by = lens) {
    Progress silent;
    return lens_gather(ldi, by, ldi.windows.data, options, silent);
}

class LensDeviceTest : public TileDeviceTest {
protected:
    // Compares both pictures; the device must have computed all tiles.
    void expect_same(const Ldi &ldi, LensGatherOptions options, double tolerance = 1e-6,
                     const ThinLens &by = lens) {
        const Image expected = gather(ldi, options, by);
        if (!device) device = open_gather_device(*info, watch());
        options.device = device.get();
        const Image image = gather(ldi, options, by);
        const TileReport did = device->take_report();
        EXPECT_GT(did.on_device, 0u);
        EXPECT_EQ(did.on_cpu, Tiles());
        EXPECT_EQ(did.failure, "");
        for (const char *step : {"lens", "download"}) EXPECT_GT(did.ms.at(step), 0) << step;
        EXPECT_EQ(did.uploaded > 0, did.ms.contains("upload"));
        EXPECT_LE(largest_difference(image, expected), tolerance); // sums in another order: rounding at most
        EXPECT_EQ(gather(ldi, options, by).values, image.values);
        device->take_report();
    }
};

TEST_F(LensDeviceTest, OpaqueSamplesAreTheCpus) {
    expect_same(surfaces(150, 90, true, 1), {.lens_samples = 8});
}

TEST_F(LensDeviceTest, PartialSamplesAreTheCpus) {
    expect_same(surfaces(150, 90, false, 2), {.lens_samples = 8});
}

// Far out of focus on both sides of it, except for a corner.
TEST_F(LensDeviceTest, CellsAreTheCpus) {
    const ThinLens wide{.radius = 0.6, .focal_px = 640, .focus = 5};
    const Ldi ldi = make_ldi(windows_of_size(140, 60), rgba_channels(), [&](int x, int y) {
        const auto random = [&](std::uint32_t n) { return float(random_unit(x / 2, y / 2, n)); };
        std::vector<Sample> samples;
        if (x + y < 100) samples.push_back({depth_of(wide, -45), {random(1), random(2), random(3), 1}});
        samples.push_back({depth_of(wide, x > 132 ? 0 : 60), {random(4), random(5), random(6), 1}});
        return samples;
    });
    expect_same(ldi, {.quality = Quality::draft}, 1e-6, wide);
}

// Discs less than half a pixel wide, but more than that high.
TEST_F(LensDeviceTest, HighDiscsAreTheCpus) {
    ThinLens high = lens;
    high.pixel_aspect = 2;
    Windows windows = windows_of_size(70, 60);
    windows.pixel_aspect = 2;
    const Ldi ldi = make_ldi(windows, {{"Y"}}, [&](int x, int y) {
        return std::vector<Sample>{{depth_of(high, 0.4), {float(random_unit(x, y, 7))}}};
    });
    expect_same(ldi, {}, 1e-6, high);
}

TEST_F(LensDeviceTest, HighlightsAreAddedToIt) {
    // Some fillers cast shadows on highlights. The device must not draw these fillers.
    for (const bool some : {false, true})
        expect_same(random_surfaces(windows_of_size(90, 60), lens, some, 6), {.lens_samples = 8});
}

TEST_F(LensDeviceTest, ManyPartialSamplesOfAPixelAreTheCpus) {
    const Ldi ldi = make_ldi(windows_of_size(40, 30), {{"Y"}, {"A"}}, [](int x, int y) {
        std::vector<Sample> samples;
        for (int i = 0; i < 24; ++i) {
            const float a = float(0.2 * random_unit(x, y, std::uint32_t(i)));
            samples.push_back({depth_of(lens, -6 + 0.4 * i + 0.1 * random_unit(x, y, std::uint32_t(100 + i))),
                               {a * float(random_unit(x, y, std::uint32_t(200 + i))), a}});
        }
        return samples;
    });
    expect_same(ldi, {.lens_samples = 6});
}

TEST_F(LensDeviceTest, ShapesOfTheLensAreTheCpus) {
    const std::vector<LensLooks> shapes{
        {.aperture = {.blades = 6}, .field_curvature = 0.3, .magnification = 1.1},
        {.aperture = {.blades = 5, .curvature = 0.6, .rotation = 20}},
        {.aperture = {.squeeze = 2}},
        {.aperture = {.blades = 7, .squeeze = 0.5}},
        {.tilt = {0.3, -0.2}},
        {.astigmatism = 0.8},
        {.chromatic_coc = {1.5, 0, -1.5}},
    };
    for (const LensLooks &looks : shapes)
        expect_same(surfaces(80, 60, false, 3), {.lens_samples = 4, .looks = looks});
}

TEST_F(LensDeviceTest, LensPointsThatWeighDifferentlyAreTheCpus) {
    LensLooks sides, colours, coloured_sides;
    sides.aperture.spherical = 0.5;
    coloured_sides.aperture.spherical = {-0.3, 0.2, 0.7};
    colours.aperture.picture =
        std::make_shared<AperturePicture>(AperturePicture{2, 1, {1, 0.2f, 0, 0.3f, 1, 1}});
    for (const LensLooks &looks : {sides, colours, coloured_sides})
        for (const bool opaque : {true, false})
            expect_same(surfaces(80, 60, opaque, 9), {.lens_samples = 6, .looks = looks});
}

TEST_F(LensDeviceTest, PixelsThatSeeThroughSomeLensPointsAreTheCpus) {
    LensLooks looks;
    looks.cat_eye = 0.9;
    const Ldi ldi = surfaces(90, 60, false, 10);
    for (const bool darkening : {false, true}) {
        looks.cat_eye_darkening = darkening;
        expect_same(ldi, {.lens_samples = 8, .looks = looks});
    }
    looks.aperture.spherical = -0.5;
    expect_same(ldi, {.lens_samples = 8, .looks = looks});
}

// Half of the surfaces show images at other depths.
TEST_F(LensDeviceTest, MirrorsAndGlassAreTheCpus) {
    for (const bool opaque : {true, false}) {
        Ldi ldi = surfaces(90, 60, opaque, 11);
        for (std::size_t i = 0; i < ldi.z.size(); ++i)
            ldi.image_z.push_back(ldi.z[i] * (random_unit(int(i), 0, 12) < 0.5 ? 1 : 1.7f));
        expect_same(ldi, {.lens_samples = 8});
        LensLooks looks;
        looks.aperture.spherical = 0.5;
        expect_same(ldi, {.lens_samples = 8, .looks = looks});
    }
}

void add_solids(Ldi &ldi) {
    for (std::size_t i = 0; i < ldi.z.size(); ++i)
        ldi.solid.push_back(
            float(std::max(3 * random_unit(int(i), 2, 12) - 1, 0.0) / (lens.radius * lens.focal_px)));
}

TEST_F(LensDeviceTest, WhatIsSolidIsTheCpus) {
    for (const bool opaque : {true, false}) {
        Ldi ldi = surfaces(90, 60, opaque, 17);
        add_solids(ldi);
        expect_same(ldi, {.lens_samples = 8});
        LensLooks looks;
        looks.aperture.spherical = 0.5;
        looks.cat_eye = 0.9;
        expect_same(ldi, {.lens_samples = 8, .looks = looks});
        ldi.image_z = ldi.z;
        for (std::size_t i = 0; i < ldi.z.size(); i += 3) ldi.image_z[i] *= 1.7f;
        expect_same(ldi, {.lens_samples = 8});
    }
}

TEST_F(LensDeviceTest, StripesMakeTheSamePicture) {
    Ldi ldi = surfaces(900, 8, false, 4); // 15 tiles, of which a buffer holds 10
    add_solids(ldi);
    Watch small = watch();
    small.largest_buffer = 5 << 17;
    device = open_gather_device(*info, small);
    expect_same(ldi, {.lens_samples = 8});
    const auto by = [&](TileDevice *used) { return gather(ldi, {.lens_samples = 8, .device = used}); };
    expect_exceeds_buffers(by, by(nullptr));
}

// Depths are looked up in single precision; equal depths of the holdout stay equal.
TEST_F(LensDeviceTest, HoldoutsAreTheCpus) {
    const Ldi ldi = surfaces(90, 60, false, 12);
    Ldi volumes = surfaces(50, 50, false, 13);
    volumes.windows.data = {{20, 10}, {69, 59}};
    for (const float z : volumes.z) volumes.z_back.push_back(z * 1.2f);
    LensLooks looks;
    looks.aperture.spherical = 0.5;
    for (const Ldi &by : {ldi, tidy(volumes)}) {
        const Holdout holdout(by);
        expect_same(ldi, {.lens_samples = 8, .holdout = &holdout}, 1e-5);
        expect_same(ldi, {.lens_samples = 8, .looks = looks, .holdout = &holdout}, 1e-5);
    }
}

// A pass has a few lens points; the CPU computes tiles where one lens point takes too long.
TEST_F(LensDeviceTest, WhatTakesLongTakesPasses) {
    LensLooks looks;
    looks.aperture.spherical = 0.5;
    looks.cat_eye = 0.9;
    Watch few = watch();
    for (const double turns : {16000.0, 6000.0}) {
        few.most_turns = turns;
        device = open_gather_device(*info, few);
        expect_same(surfaces(90, 60, false, 14), {.lens_samples = 9});
        expect_same(surfaces(70, 60, false, 14), {.lens_samples = 9, .looks = looks});
    }
    few.most_turns = 99;
    device = open_gather_device(*info, few);
    const Ldi ldi = surfaces(40, 30, true, 14);
    EXPECT_EQ(gather(ldi, {.lens_samples = 4, .device = device.get()}).values,
              gather(ldi, {.lens_samples = 4}).values);
    const TileReport did = device->take_report();
    EXPECT_EQ(did.on_device, 0u);
    EXPECT_EQ(did.on_cpu, (Tiles{{"more steps than the device takes", 1}}));
}

// Unchanged data stays on the device: the positions, depths, coverages and most colours of these frames.
TEST_F(LensDeviceTest, APullOfFocusUploadsSamplesOnce) {
    // A third of it is nearly in focus, where each frame sharpens different colours.
    Ldi ldi = make_ldi(windows_of_size(150, 60), {{"Y"}, {"A"}}, [](int x, int y) {
        const auto y_of = [&](std::uint32_t stream) { return float(random_unit(x, y, stream)); };
        const Sample wall{x < 100 ? 9.0f : 5.0f, {y_of(1), 1}}, veil{3, {y_of(2) / 3, 0.4f}};
        return y < 30 ? std::vector<Sample>{veil, wall} : std::vector<Sample>{wall};
    });
    device = open_gather_device(*info, watch());
    std::vector<std::size_t> uploaded;
    const auto frame = [&](double focus, const Ldi &of) {
        ThinLens by = lens;
        by.focus = focus;
        Progress silent;
        const auto gathered = [&](TileDevice *on) {
            return lens_gather(of, by, of.windows.data, {.lens_samples = 4, .device = on}, silent);
        };
        const auto fresh = open_gather_device(*info, watch());
        const Image image = gathered(device.get());
        EXPECT_EQ(image.values, gathered(fresh.get()).values) << focus;
        EXPECT_LE(largest_difference(image, gathered(nullptr)), 1e-6) << focus;
        const TileReport did = device->take_report();
        EXPECT_EQ(did.on_cpu, Tiles());
        uploaded.push_back(did.uploaded);
    };
    for (const double focus : {5.0, 4.8, 4.6, 4.6}) frame(focus, ldi);
    for (std::vector<float> &values : ldi.values)
        std::ranges::reverse(values); // another picture of the same size
    frame(4.6, ldi);
    frame(4.6, surfaces(60, 150, true, 16));
    EXPECT_LT(2 * uploaded[1], uploaded[0]);
    EXPECT_LT(2 * uploaded[2], uploaded[0]);
    EXPECT_EQ(uploaded[3], 0u); // nothing has changed
    EXPECT_GT(uploaded[4], uploaded[0] / 3);
}

TEST_F(LensDeviceTest, AFailureLosesNothing) {
    const Ldi ldi = surfaces(30, 20, false, 8);
    const auto by = [&](TileDevice *used) { return gather(ldi, {.lens_samples = 4, .device = used}); };
    expect_bears_failures(by, by(nullptr), 1e-6);
}

TEST_F(LensDeviceTest, LittleMemoryIsEnough) {
    const Ldi ldi = surfaces(32000, 2, false, 18); // 500 tiles
    const auto by = [&](TileDevice *used) { return gather(ldi, {.lens_samples = 2, .device = used}); };
    expect_needs_little_memory(by, by(nullptr), 1e-6);
}

TEST_F(LensDeviceTest, WhatExceedsItsMemoryIsTheCpus) {
    const Ldi ldi = surfaces(900, 700, false, 18);
    const auto by = [&](TileDevice *used) { return gather(ldi, {.lens_samples = 2, .device = used}); };
    expect_exceeds_memory([&] {
        device = open_gather_device(*info, watch());
        EXPECT_EQ(by(device.get()).values, by(nullptr).values);
        return device->take_report();
    });
}

} // namespace
} // namespace sparselens::gpu
