#include "deep/packed_rows.h"
#include "dof/gather_picture.h"
#include "dof/gather_rows.h"
#include "dof/merge_layers.h"
#include "support/ldi_samples.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sparselens {
namespace {

TEST(Volumes, ThinSmokeShowsItsMiddleAndDenseSmokeItsFront) {
    EXPECT_DOUBLE_EQ(shown_depth(0), 0.5);
    EXPECT_DOUBLE_EQ(shown_depth(1), 0);
    EXPECT_NEAR(shown_depth(1e-4), shown_depth(0.999e-4), 1e-7);
}

TEST(Volumes, AVolumeShowsItsLightWhereManySlicesDo) {
    constexpr int slices = 4096;
    for (const double alpha : {0.01, 0.3, 0.5, 0.9, 0.999}) {
        const double of_slice = 1 - std::pow(1 - alpha, 1.0 / slices);
        double shown = 0, depths = 0, transmittance = 1;
        for (int k = 0; k < slices; ++k) {
            shown += transmittance * of_slice;
            depths += transmittance * of_slice * (k + 0.5) / slices;
            transmittance *= 1 - of_slice;
        }
        EXPECT_NEAR(shown_depth(alpha), depths / shown, 1e-5) << alpha;
    }
}

TEST(Volumes, PointsEndlessVolumesAndLdisWithoutAlphaStay) {
    constexpr float endless = std::numeric_limits<float>::infinity();
    const TestPixel pixel{{.z = 2, .alpha = 0.5f}, {.z = 3, .alpha = 0.5f, .z_back = endless}};
    Ldi ldi = ldi_of({pixel});
    EXPECT_EQ(at_shown_depths(ldi).z, ldi.z);
    EXPECT_EQ(at_shown_depths(ldi).z_back, ldi.z_back);
    ldi = ldi_of({{{.z = 2, .alpha = 1e-3f, .z_back = 4}}});
    EXPECT_NEAR(double(at_shown_depths(ldi).z[0]), 3, 1e-3);
    ldi.channels.back().name = "other";
    EXPECT_EQ(at_shown_depths(ldi).z, ldi.z);
}

TEST(Volumes, StayVolumesWhoseDepthsAreChosenWhenTheyAreMergedAgain) {
    constexpr float endless = std::numeric_limits<float>::infinity();
    const Ldi ldi = ldi_of({{{.z = 2, .alpha = 0.1f, .z_back = 2.01f},
                             {.z = 2.01f, .alpha = 0.1f, .z_back = 2.02f},
                             {.z = 4, .alpha = 0.1f, .z_back = 4.01f},
                             {.z = 4.01f}}});
    const Ldi once = merge_layers(ldi, 4, 0.25);
    EXPECT_EQ(once.z_back, (std::vector<float>{endless, once.z[1]})); // the surface makes a point of its run
    EXPECT_NEAR(double(once.z[0]), 2.01, 1e-3);
    const Ldi again = merge_layers(once, 4, 0.25);
    EXPECT_EQ(again.z, once.z);
    EXPECT_EQ(again.z_back, once.z_back);
}

TEST(Volumes, ImagesInMirrorsMoveAsFar) {
    Ldi ldi = ldi_of({{{.z = 2, .alpha = 0.5f, .z_back = 4}}});
    ldi.image_z = {7};
    const Ldi moved = at_shown_depths(ldi);
    EXPECT_GT(moved.z[0], 2.5f);
    EXPECT_FLOAT_EQ(moved.image_z[0] - 7, moved.z[0] - 2);
}

TEST(Volumes, BandsReachAsFarAsTheirBacks) {
    const ThinLens lens{.radius = 0.1, .focal_px = 1000, .focus = 2};
    const auto seen = [&](const Ldi &ldi) {
        PackedRows rows(ldi.windows);
        rows.append(ldi);
        return reach_of(rows, lens, {}).seen;
    };
    const Ldi ldi = ldi_of({{{.z = 2, .alpha = 1}}}), volume = ldi_of({{{.z = 2, .alpha = 1, .z_back = 20}}}),
              at_back = ldi_of({{{.z = 20, .alpha = 1}}});
    EXPECT_GE(seen(volume), seen(at_back));
    EXPECT_LT(seen(ldi), seen(volume));
}

// A picture of one row, with a block of smoke in the middle that is divided into slices. Each slice is a volume, or a
// point at its front.
Image picture_of_smoke(int slices, bool volumes) {
    const Windows windows = windows_of_size(64, 1);
    const float alpha = 0.6f, of_slice = 1 - std::pow(1 - alpha, 1 / float(slices));
    const Ldi ldi = make_ldi(windows, rgba_channels(), [&](int x, int) {
        std::vector<Sample> samples;
        for (int k = 0; k < slices && x >= 24 && x < 40; ++k)
            samples.push_back({.z = 3 + 2.0 * k / slices,
                               .values = {of_slice, of_slice, of_slice, of_slice},
                               .z_back = volumes ? float(3 + 2.0 * (k + 1) / slices) : 0});
        return samples;
    });
    const ThinLens lens{.radius = 0.05, .focal_px = 500, .focus = 8};
    Progress silent;
    return gather_picture(ldi, lens, windows.data, windows.data, {}, silent);
}

TEST(Volumes, TheGatheredVolumeIsThatOfItsSlices) {
    const Image many = picture_of_smoke(64, true);
    EXPECT_LT(largest_difference(picture_of_smoke(1, true), many),
              largest_difference(picture_of_smoke(1, false), many) / 2);
}

} // namespace
} // namespace sparselens
