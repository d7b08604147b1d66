#include "lens/thin_lens.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

constexpr ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};
constexpr double scale = lens.radius * lens.focal_px;

TEST(Disparity, IsThatOfTheLens) {
    EXPECT_EQ(disparity_scale(lens.radius, lens.focal_px), scale);
    for (const double z : {0.25, 3.0, 1e9}) {
        EXPECT_EQ(disparity(scale, z), disparity(lens, z));
        EXPECT_DOUBLE_EQ(depth_at_disparity(scale, disparity(scale, z)), z);
    }
}

TEST(Disparity, AStepOfItIsOneOfInverseDepth) {
    const double near = disparity(scale, 2), far = disparity(scale, 8);
    EXPECT_DOUBLE_EQ(inverse_depth_step(scale, near - far), 1.0 / 2 - 1.0 / 8);
}

} // namespace
} // namespace sparselens
