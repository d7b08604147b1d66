#include "base/error.h"
#include "deep/build.h"
#include "io/camera/camera_header.h"
#include "io/exr/exr_deep.h"
#include "io/exr/exr_flat.h"
#include "io/open_ldi.h"
#include "io/open_view.h"
#include "support/ldi_samples.h"
#include "support/scratch_folder.h"

#include <ImfFloatAttribute.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

namespace sparselens {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();

class Opened : public testing::Test {
protected:
    ScratchFolder folder;
    std::string path = folder.file("picture.exr");

    // Writes the depths and coverages of a flat picture of one row.
    void write(const std::vector<float> &depths, const std::vector<float> &alphas,
               const Imath::V2f &screen_window_centre = {0, 0}) {
        Image image(windows_of_size(int(depths.size()), 1), {{"R"}, {"A"}, {"Z", PixelType::float32}});
        std::ranges::copy(alphas, image.plane(0).begin());
        std::ranges::copy(alphas, image.plane(1).begin());
        std::ranges::copy(depths, image.plane(2).begin());
        Imf::Header header;
        header.screenWindowCenter() = screen_window_centre;
        write_flat_exr(path, image, header);
    }
    std::vector<float> depths_of_view(const DepthOptions &depth = {}, const LensValues &lens = {}) {
        return open_view(path, {lens, depth}).view.z;
    }
    std::vector<float> depths_of_ldi(const DepthOptions &depth = {}, const LensValues &lens = {}) {
        return open_ldi(path, {lens, depth}).ldi.z;
    }
};

TEST_F(Opened, PlanarDepthComesAsItIs) {
    write({1, 2.5f, 1e9f, inf}, {1, 1, 1, 1});
    EXPECT_EQ(depths_of_view(), (std::vector<float>{1, 2.5f, 1e9f, inf}));
    EXPECT_EQ(depths_of_ldi(), (std::vector<float>{1, 2.5f, 1e9f, inf}));
}

TEST_F(Opened, SkyIsInfinitelyFar) {
    write({1, 65504, 1e10f, 1e30f}, {1, 1, 1, 1});
    EXPECT_EQ(depths_of_view(), (std::vector<float>{1, inf, inf, inf}));
    EXPECT_EQ(depths_of_ldi(), (std::vector<float>{1, inf, inf, inf}));
}

// The edge of an element over nothing, as renderers write it.
TEST_F(Opened, PartlyCoveredPixelsOfTheSkyTakeTheDepthBesideThem) {
    write({4, 1e10f, 1e10f, 5}, {1, 0.5f, 0, 1});
    EXPECT_EQ(depths_of_view(), (std::vector<float>{4, 4, inf, 5}));
    EXPECT_EQ(depths_of_ldi(), (std::vector<float>{4, 4, 5}));
    EXPECT_EQ(open_view(path).notes.back(), "1 pixel on an edge takes the depth of the surface it shows");
    EXPECT_EQ(open_ldi(path).notes.back(), "1 pixel on an edge takes the depth of the surface it shows");
}

TEST_F(Opened, ZeroSaysThatNothingWasHit) {
    write({0, 2, -0.0f}, {1, 1, 1});
    EXPECT_EQ(depths_of_view(), (std::vector<float>{inf, 2, inf}));
    EXPECT_EQ(depths_of_ldi(), (std::vector<float>{inf, 2, inf}));
}

TEST_F(Opened, WithoutCoverageAnyDepthDoes) {
    write({-1, 2, std::nanf("")}, {0, 1, 0});
    EXPECT_EQ(depths_of_view(), (std::vector<float>{inf, 2, inf}));
    EXPECT_EQ(depths_of_ldi(), (std::vector<float>{2}));
}

TEST_F(Opened, OtherDepthsAreErrorsThatNameThePixel) {
    for (const float bad : {-3.0f, std::nanf(""), -inf}) {
        write({1, bad}, {1, 1});
        for (const std::string &what :
             {what_of<Error>([&] { depths_of_view(); }), what_of<Error>([&] { depths_of_ldi(); })}) {
            EXPECT_TRUE(what.starts_with(path + ": depth ")) << what;
            EXPECT_NE(what.find(" in pixel 1,0 is not a number above 0"), std::string::npos) << what;
        }
    }
}

TEST_F(Opened, InverseDepth) {
    write({0.5f, 0, 4}, {1, 1, 1});
    const DepthOptions inverse{.meaning = DepthMeaning::inverse};
    EXPECT_EQ(depths_of_view(inverse), (std::vector<float>{2, inf, 0.25f}));
    EXPECT_EQ(depths_of_ldi(inverse), (std::vector<float>{2, inf, 0.25f}));
}

TEST_F(Opened, NegativeDepth) {
    write({-2, -1e10f, -0.25f}, {1, 1, 1});
    const DepthOptions negative{.meaning = DepthMeaning::negative};
    EXPECT_EQ(depths_of_view(negative), (std::vector<float>{2, inf, 0.25f}));
    EXPECT_EQ(depths_of_ldi(negative), (std::vector<float>{2, inf, 0.25f}));
}

TEST_F(Opened, NormalizedDepthNeedsBothPlanes) {
    write({0, 0.5f, 1}, {1, 1, 1});
    DepthOptions normalized{.meaning = DepthMeaning::normalized};
    EXPECT_THROW(depths_of_view(normalized), UsageError);
    normalized.near = 2;
    EXPECT_THROW(depths_of_ldi(normalized), UsageError);
    normalized.far = 2;
    EXPECT_THROW(depths_of_ldi(normalized), UsageError); // the same error
    normalized.far = 1;                                  // white near: 0 is at 2, the sky; 1 is at 1
    EXPECT_EQ(depths_of_view(normalized), (std::vector<float>{inf, 1.5f, 1}));
    EXPECT_EQ(depths_of_ldi(normalized), (std::vector<float>{inf, 1.5f, 1}));
    normalized.far = 10;
    EXPECT_EQ(depths_of_view(normalized), (std::vector<float>{2, 6, inf}));
    EXPECT_EQ(depths_of_ldi(normalized), (std::vector<float>{2, 6, inf}));
    DepthOptions hyperbolic = normalized;
    hyperbolic.meaning = DepthMeaning::hyperbolic;
    EXPECT_EQ(depths_of_view(hyperbolic), depths_of_ldi(hyperbolic));
    EXPECT_FLOAT_EQ(depths_of_view(hyperbolic)[1], 1 / 0.3f); // the mean of 1 / 2 and 1 / 10
    normalized.far = double(inf);
    EXPECT_EQ(depths_of_view(normalized), (std::vector<float>{2, 4, inf}));
    EXPECT_THROW(depths_of_view({.near = 1.0}), UsageError); // it has no effect
}

TEST_F(Opened, PlanesOfNormalizedDepthComeFromTheHeader) {
    Image image(windows_of_size(2, 1), {{"R"}, {"Z", PixelType::float32}});
    image.values = {1, 1, 0, 0.5f};
    Imf::Header header;
    header.insert("near", Imf::FloatAttribute(4));
    header.insert("far", Imf::FloatAttribute(8));
    write_flat_exr(path, image, header);
    DepthOptions normalized{.meaning = DepthMeaning::normalized};
    EXPECT_EQ(depths_of_view(normalized), (std::vector<float>{4, 6}));
    normalized.far = 16; // options take precedence
    EXPECT_EQ(depths_of_ldi(normalized), (std::vector<float>{4, 10}));
}

TEST_F(Opened, DepthsThatEndAtOneAreAWarning) {
    const auto warnings = [&] { return open_ldi(path).warnings.size() + open_view(path).warnings.size(); };
    write({0.2f, 0.5f, 1}, {1, 1, 1});
    EXPECT_EQ(warnings(), 2u);
    for (const std::vector<float> &depths : {std::vector<float>{0.2f, 0.5f, 0.9f}, {1, 1, 1}, {0.5f, 1, 2}}) {
        write(depths, {1, 1, 1});
        EXPECT_EQ(warnings(), 0u);
    }
}

// F = 1 pixel, and the optical axis goes through the first of three pixels, a third of the width left of the middle.
TEST_F(Opened, DistanceFollowsAShiftedLens) {
    write({2, 2, 2}, {1, 1, 1}, {1.0f / 3, 0});
    const DepthOptions distance{.meaning = DepthMeaning::distance};
    LensValues lens;
    lens.focal_length_mm = 12;
    lens.sensor_width_mm = 36;
    const std::vector<float> expected{2, float(std::sqrt(2.0)), float(2 / std::sqrt(5.0))};
    for (const auto &depths : {depths_of_view(distance, lens), depths_of_ldi(distance, lens)})
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(depths[i], expected[i], 1e-6);
}

// If a rim view does not state its frustum, the centre's is used.
TEST_F(Opened, DistanceInASilentViewIsAsInTheCentre) {
    write({2, 2, 2}, {1, 1, 1});
    const DepthOptions distance{.meaning = DepthMeaning::distance};
    Camera centre;
    centre.field = 3;
    centre.principal_point = {-1.0 / 3, 0};
    const std::vector<float> z = open_view(path, {.depth = distance}, centre).view.z;
    EXPECT_NEAR(z[0], 2, 1e-6);
    EXPECT_NEAR(z[1], std::sqrt(2.0), 1e-6);
}

// F = 1 pixel, three pixels in a row: 45 degrees on either side of the axis.
TEST_F(Opened, DistanceNeedsTheFocalLength) {
    write({2, 2, 2}, {1, 1, 1});
    const DepthOptions distance{.meaning = DepthMeaning::distance};
    LensValues lens;
    EXPECT_THROW(depths_of_view(distance, lens), UsageError);
    EXPECT_THROW(depths_of_ldi(distance, lens), UsageError);
    lens.focal_length_mm = 12;
    lens.sensor_width_mm = 36;
    const float slanted = float(std::sqrt(2.0));
    EXPECT_EQ(depths_of_view(distance, lens), (std::vector<float>{slanted, 2, slanted}));
    EXPECT_EQ(depths_of_ldi(distance, lens), (std::vector<float>{slanted, 2, slanted}));
}

TEST_F(Opened, DeepFilesComeTidyBackDepthsToo) {
    write_ldi(path,
              ldi_of({{{.z = 0.25f, .alpha = 0.5f, .z_back = 0.125f},
                       {.z = 0.5f, .alpha = 0.5f},
                       {.z = 9, .colour = 0, .alpha = 0}}}),
              Imf::Header());
    const DepthOptions inverse{.meaning = DepthMeaning::inverse};
    const Ldi ldi = open_ldi(path, {.depth = inverse}).ldi;
    EXPECT_EQ(ldi.z, (std::vector<float>{2, 4}));
    EXPECT_EQ(ldi.z_back, (std::vector<float>{2, 8}));
}

// A lens with a radius of 1 cm and F = 6 pixels, focused at 4 m.
Imf::Header header_with_lens() {
    Camera camera;
    camera.focal_length_mm = 50;
    camera.sensor_width_mm = 25;
    camera.fstop = 2.5;
    camera.focus_distance = 4;
    Imf::Header header;
    write_camera(header, camera);
    return header;
}

TEST_F(Opened, AnLdiHasTheLensOfItsFile) {
    write_ldi(path, ldi_of({{{.z = 1}}, {{.z = 2}}, {{.z = 3}}}), header_with_lens());
    const OpenedLdi in = open_ldi(path);
    EXPECT_EQ(in.name, path);
    EXPECT_NEAR(in.lens().radius, 0.01, 1e-9);
    EXPECT_DOUBLE_EQ(in.lens().focal_px, 2 * in.ldi.windows.display_width());
    EXPECT_EQ(in.lens().focus, 4);
    const ThinLens changed = open_ldi(path, {.lens = {.lens_radius = 0.25, .focus_distance = 3}}).lens();
    EXPECT_EQ(changed.radius, 0.25);
    EXPECT_EQ(changed.focus, 3);
    EXPECT_DOUBLE_EQ(changed.focal_px, in.lens().focal_px);
}

TEST_F(Opened, AViewHasTheLensOfItsFile) {
    Image image(windows_of_size(3, 1), {{"R"}, {"A"}, {"Z", PixelType::float32}});
    std::ranges::fill(image.values, 1.0f);
    write_flat_exr(path, image, header_with_lens());
    const OpenedView in = open_view(path);
    EXPECT_NEAR(in.lens().radius, 0.01, 1e-9);
    EXPECT_DOUBLE_EQ(in.lens().focal_px, 6);
    EXPECT_EQ(in.lens().focus, 4);
    EXPECT_EQ(open_view(path, {.lens = {.focus_distance = 3}}).lens().focus, 3);
}

TEST_F(Opened, WithoutALensTheLensIsAnErrorAndTheSamplesAreNot) {
    write({1, 2}, {1, 1});
    const OpenedLdi in = open_ldi(path);
    EXPECT_EQ(in.ldi.samples(), 2u);
    EXPECT_EQ(what_of<UsageError>([&] { in.lens(); }),
              "the aperture is unknown: give `fstop` or `lens_radius`; the focal length is unknown: give "
              "`focal_length`; the sensor width is unknown: give `sensor_width`; the focus distance is "
              "unknown: give `focus_distance`");
    const OpenedView view = open_view(path);
    EXPECT_THROW(view.lens(), UsageError);
}

TEST_F(Opened, RepairsAreCounted) {
    write({1, -3, 2}, {1, 1, 1});
    const OpenedLdi in = open_ldi(path);
    EXPECT_TRUE(in.bad.any());
    for (const float z : in.ldi.z) EXPECT_GT(z, 0);
    EXPECT_TRUE(open_view(path).bad.any());
    write({1, 3, 2}, {1, 1, 0});
    const OpenedLdi sound = open_ldi(path);
    EXPECT_FALSE(sound.bad.any());
    EXPECT_EQ(sound.invisible, 1u); // without coverage
}

class OpenedByRows : public Opened {
protected:
    Ldi ldi = random_ldi({.seed = 4, .width = 20, .height = 150, .opaque_share = 0.2, .depths = 64});
    std::mutex reducing;        // for the variables below: several threads reduce rows
    int asked = 0;              // how often open_ldi() asked
    std::map<int, int> heights; // first row -> number of reduced rows

    OpenedLdi open(const ReduceSamples &reduce) {
        write_ldi(path, ldi, {});
        return open_ldi(path, {}, [&](const Imf::Header &, const Camera &, const Ldi &) -> ReduceSamples {
            ++asked;
            if (!reduce) return {};
            return [&](Ldi rows) {
                {
                    const std::lock_guard lock(reducing);
                    heights[rows.windows.data.min.y] = rows.windows.height();
                }
                return reduce(std::move(rows));
            };
        });
    }
    OpenedLdi open_unchanged() {
        return open([](Ldi rows) { return rows; });
    }
    void expect_whole(const OpenedLdi &opened) const {
        const OpenedLdi whole = open_ldi(path);
        EXPECT_EQ(opened.ldi.begin, whole.ldi.begin);
        EXPECT_EQ(opened.ldi.z, whole.ldi.z);
        EXPECT_EQ(opened.ldi.values, whole.ldi.values);
        EXPECT_EQ(opened.samples_read, whole.ldi.samples());
        EXPECT_EQ(opened.invisible, whole.invisible);
        EXPECT_EQ(opened.warnings, whole.warnings);
    }
};

TEST_F(OpenedByRows, RowsThatStayMakeTheWholePicture) {
    const OpenedLdi opened = open_unchanged();
    EXPECT_TRUE(opened.reduced());
    EXPECT_EQ(asked, 1);
    std::map<int, int> expected{{144, 6}};
    for (int y = 0; y < 144; y += 16) expected[y] = 16;
    EXPECT_EQ(heights, expected);
    expect_whole(opened);
}

TEST_F(OpenedByRows, FewerSamplesAreKeptAndThoseReadAreCounted) {
    const OpenedLdi opened = open([](Ldi rows) {
        Ldi none = empty_like(rows);
        none.begin.assign(rows.begin.size(), 0);
        return none;
    });
    EXPECT_EQ(opened.ldi.samples(), 0u);
    EXPECT_EQ(opened.samples_read, open_ldi(path).ldi.samples());
}

TEST_F(OpenedByRows, WhereAllSamplesAreNeededAllAreRead) {
    const OpenedLdi opened = open({});
    EXPECT_FALSE(opened.reduced());
    EXPECT_EQ(asked, 1);
    expect_whole(opened);
}

TEST_F(OpenedByRows, InvalidValuesAreRepairedFromAllRows) {
    ldi.values[0][ldi.begin[20 * 64]] = inf; // the first sample of row 64
    const OpenedLdi opened = open_unchanged();
    EXPECT_FALSE(opened.reduced());
    EXPECT_EQ(opened.bad.colours, 1u);
    expect_whole(opened);
}

TEST_F(Opened, WhatIsNotThereIsAnErrorThatNamesIt) {
    const std::string lost = folder.file("lost.exr");
    for (const std::string &what :
         {what_of<Error>([&] { open_ldi(lost); }), what_of<Error>([&] { open_view(lost); })})
        EXPECT_TRUE(what.starts_with(lost + ": ")) << what;
}

} // namespace
} // namespace sparselens
