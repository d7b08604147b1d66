#include "base/error.h"
#include "io/exr/exr_flat.h"
#include "loading/pictures.h"
#include "support/ldi_samples.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sparselens {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();

class Pictures : public testing::Test {
protected:
    ScratchFolder folder;
    std::string path = folder.file("picture.exr");

    // Depths and coverage of the pixels of a flat picture of one row.
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
    std::vector<float> depths_of_view(const DepthOptions &depth = {}, const LensOptions &lens = {}) {
        return load_view(path, lens, depth).view.z;
    }
    std::vector<float> depths_of_ldi(const DepthOptions &depth = {}, const LensOptions &lens = {}) {
        return load_ldi(path, lens, depth).ldi.z;
    }
};

TEST_F(Pictures, PlanarDepthComesAsItIs) {
    write({1, 2.5f, 1e9f, inf}, {1, 1, 0.5f, 1});
    EXPECT_EQ(depths_of_view(), (std::vector<float>{1, 2.5f, 1e9f, inf}));
    EXPECT_EQ(depths_of_ldi(), (std::vector<float>{1, 2.5f, 1e9f, inf}));
}

TEST_F(Pictures, SkyIsInfinitelyFar) {
    write({1, 65504, 1e10f, 1e30f}, {1, 1, 0.5f, 1});
    EXPECT_EQ(depths_of_view(), (std::vector<float>{1, inf, inf, inf}));
    EXPECT_EQ(depths_of_ldi(), (std::vector<float>{1, inf, inf, inf}));
}

TEST_F(Pictures, ZeroSaysThatNothingWasHit) {
    write({0, 2, -0.0f}, {1, 1, 1});
    EXPECT_EQ(depths_of_view(), (std::vector<float>{inf, 2, inf}));
    EXPECT_EQ(depths_of_ldi(), (std::vector<float>{inf, 2, inf}));
}

TEST_F(Pictures, WithoutCoverageAnyDepthDoes) {
    write({-1, 2, std::nanf("")}, {0, 1, 0});
    EXPECT_EQ(depths_of_view(), (std::vector<float>{inf, 2, inf}));
    EXPECT_EQ(depths_of_ldi(), (std::vector<float>{2}));
}

TEST_F(Pictures, OtherDepthsAreErrorsThatNameThePixel) {
    for (const float bad : {-3.0f, std::nanf(""), -inf}) {
        write({1, bad}, {1, 1});
        for (const std::string &what :
             {what_of<Error>([&] { depths_of_view(); }), what_of<Error>([&] { depths_of_ldi(); })}) {
            EXPECT_TRUE(what.starts_with(path + ": depth ")) << what;
            EXPECT_NE(what.find(" in pixel 1,0 is not a number above 0"), std::string::npos) << what;
        }
    }
}

TEST_F(Pictures, InverseDepth) {
    write({0.5f, 0, 4}, {1, 1, 1});
    const DepthOptions inverse{.meaning = DepthMeaning::inverse, .channel = {}};
    EXPECT_EQ(depths_of_view(inverse), (std::vector<float>{2, inf, 0.25f}));
    EXPECT_EQ(depths_of_ldi(inverse), (std::vector<float>{2, inf, 0.25f}));
}

// F = 1 pixel, and the optical axis goes through the first of three pixels, a third of the width left of the middle.
TEST_F(Pictures, DistanceFollowsAShiftedLens) {
    write({2, 2, 2}, {1, 1, 1}, {1.0f / 3, 0});
    const DepthOptions distance{.meaning = DepthMeaning::distance, .channel = {}};
    LensOptions lens;
    lens.focal_length_mm = 12;
    lens.sensor_width_mm = 36;
    const std::vector<float> expected{2, float(std::sqrt(2.0)), float(2 / std::sqrt(5.0))};
    for (const auto &depths : {depths_of_view(distance, lens), depths_of_ldi(distance, lens)})
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(depths[i], expected[i], 1e-6);
}

// What a rim view does not say of its frustum is as in the centre.
TEST_F(Pictures, DistanceInASilentViewIsAsInTheCentre) {
    write({2, 2, 2}, {1, 1, 1});
    const DepthOptions distance{.meaning = DepthMeaning::distance, .channel = {}};
    Camera centre;
    centre.field = 3;
    centre.principal_point = {-1.0 / 3, 0};
    const std::vector<float> z = load_view(path, {}, distance, centre).view.z;
    EXPECT_NEAR(z[0], 2, 1e-6);
    EXPECT_NEAR(z[1], std::sqrt(2.0), 1e-6);
}

// F = 1 pixel, three pixels in a row: 45 degrees on either side of the axis.
TEST_F(Pictures, DistanceNeedsTheFocalLength) {
    write({2, 2, 2}, {1, 1, 1});
    const DepthOptions distance{.meaning = DepthMeaning::distance, .channel = {}};
    LensOptions lens;
    EXPECT_THROW(depths_of_view(distance, lens), UsageError);
    EXPECT_THROW(depths_of_ldi(distance, lens), UsageError);
    lens.focal_length_mm = 12;
    lens.sensor_width_mm = 36;
    const float slanted = float(std::sqrt(2.0));
    EXPECT_EQ(depths_of_view(distance, lens), (std::vector<float>{slanted, 2, slanted}));
    EXPECT_EQ(depths_of_ldi(distance, lens), (std::vector<float>{slanted, 2, slanted}));
}

TEST_F(Pictures, DeepFilesComeTidyBackDepthsToo) {
    write_ldi(path,
              ldi_of({{{.z = 0.25f, .alpha = 0.5f, .z_back = 0.125f},
                       {.z = 0.5f, .alpha = 0.5f},
                       {.z = 9, .colour = 0, .alpha = 0}}}),
              Imf::Header());
    const DepthOptions inverse{.meaning = DepthMeaning::inverse, .channel = {}};
    const Ldi ldi = load_ldi(path, {}, inverse).ldi;
    EXPECT_EQ(ldi.z, (std::vector<float>{2, 4}));
    EXPECT_EQ(ldi.z_back, (std::vector<float>{2, 8}));
}

} // namespace
} // namespace sparselens
