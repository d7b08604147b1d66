#include "kernels/warp_rules.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sparselens {
namespace {

// Compared with the library's exp(); each of the two rounds a few times.
TEST(Nearness, IsAGaussian) {
    for (double dx = -0.5; dx <= 0.5; dx += 1.0 / 64)
        for (double dy = -0.5; dy <= 0.5; dy += 1.0 / 64) {
            const double expected = std::exp(-0.5 * (dx * dx + dy * dy) / (0.3 * 0.3));
            EXPECT_NEAR(kernels::nearness(dx, dy), expected, 4e-15 * expected) << dx << ' ' << dy;
        }
    EXPECT_EQ(kernels::nearness(0, 0), 1);
}

} // namespace
} // namespace sparselens
