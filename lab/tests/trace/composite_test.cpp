#include "lab/trace/composite.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sparselens::lab {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

TEST(Composite, CoversFrontToBack) {
    const Layer layers[] = {{1, {1, 0, 0, 0.25f}}, {2, {0, 1, 0, 0.5f}}, {inf, {0, 0, 1, 1}}};
    const Imath::C4f c = composite(layers, {});
    EXPECT_FLOAT_EQ(c.r, 0.25f);
    EXPECT_FLOAT_EQ(c.g, 0.75f * 0.5f);
    EXPECT_FLOAT_EQ(c.b, 0.75f * 0.5f);
    EXPECT_FLOAT_EQ(c.a, 1);
    EXPECT_FLOAT_EQ(composite(std::span(layers).first(2), {}).a, 1 - 0.75f * 0.5f);
    EXPECT_EQ(composite({}, {}).a, 0);
}

TEST(Composite, SlabPassesExpOfOpticalDepth) {
    const Slab slab{2, 5, 0.4, {1, 0.5f, 0}};
    const Layer wall{9, {0, 0, 1, 1}};
    const Imath::C4f c = composite({&wall, 1}, {&slab, 1});
    const float passes = float(std::exp(-1.2));
    EXPECT_NEAR(c.b, passes, 1e-6);
    EXPECT_NEAR(c.r, 1 - passes, 1e-6);
    EXPECT_NEAR(c.g, 0.5f * (1 - passes), 1e-6);
    EXPECT_EQ(c.a, 1);
}

TEST(Composite, SurfaceInsideASlabSeesItsFrontPart) {
    const Slab slab{2, 5, 0.4, {1, 1, 1}};
    const Layer wall{3, {0, 0, 0, 1}};
    EXPECT_NEAR(composite({&wall, 1}, {&slab, 1}).r, 1 - std::exp(-0.4), 1e-6);
}

// Two colours over the same stretch mix by density; elsewhere there is one colour. Computed piece by piece.
TEST(Composite, OverlappingSlabsMixByDensity) {
    const Slab slabs[] = {{1, 3, 0.5, {1, 0, 0}}, {2, 4, 0.25, {0, 1, 0}}};
    const Imath::C4f c = composite({}, slabs);
    const double p1 = std::exp(-0.5), p2 = p1 * std::exp(-0.75), p3 = p2 * std::exp(-0.25);
    EXPECT_NEAR(c.r, 1 - p1 + (p1 - p2) * 2 / 3, 1e-6);
    EXPECT_NEAR(c.g, (p1 - p2) / 3 + p2 - p3, 1e-6);
    EXPECT_NEAR(c.a, 1 - p3, 1e-6);
    EXPECT_NEAR(transmittance(slabs, 0, inf), p3, 1e-12);
    EXPECT_NEAR(transmittance(slabs, 2, 3), std::exp(-0.75), 1e-12);
}

} // namespace
} // namespace sparselens::lab
