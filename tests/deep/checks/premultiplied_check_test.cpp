#include "deep/checks/picture_checks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace sparselens {
namespace {

// A square of light with an edge of so many pixels before nothing. `shade` gives the colour of a coverage where the light
// is 1; a texture makes it 0.8 to 1.2.
EdgeFall fall_of(const std::function<float(float coverage)> &shade, float outside = 0, int edge = 3,
                 float texture = 0) {
    View view{.name = "view",
              .image = Image(windows_of_size(60, 60), rgba_channels()),
              .z = std::vector<float>(3600, 2.0f)};
    for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 60; ++x) {
            const int inwards =
                std::min(std::min(x, y), std::min(59 - x, 59 - y)) - 10; // from the square's border
            const float a = std::clamp(float(inwards) / float(edge + 1), 0.0f, 1.0f);
            const float light = (x * 7 + y * 5) % 3 == 0 ? 1 - texture : 1 + texture;
            for (std::size_t k = 0; k < 3; ++k)
                view.image.at(k, x, y) = (a > 0 ? light * shade(a) : 0) + outside;
            view.image.at(3, x, y) = a;
        }
    return fall_at_edges(flat_pixels(view));
}

TEST(PremultipliedCheck, ColoursFallWithCoverageOrStay) {
    const EdgeFall falls = fall_of([](float a) { return a; }), stays = fall_of([](float) { return 1.0f; });
    EXPECT_GT(falls.pixels, 100u);
    EXPECT_NEAR(falls.stays, 0, 1e-6);
    EXPECT_FALSE(looks_unpremultiplied(falls));
    EXPECT_NEAR(stays.stays, 1, 1e-6);
    EXPECT_TRUE(looks_unpremultiplied(stays));
}

TEST(PremultipliedCheck, SoftRimsOfTexturedSurfacesTell) {
    EXPECT_TRUE(looks_unpremultiplied(fall_of([](float) { return 1.0f; }, 0, 6, 0.2f)));
    EXPECT_FALSE(looks_unpremultiplied(fall_of([](float a) { return a; }, 0, 6, 0.2f)));
    EXPECT_FALSE(looks_unpremultiplied(fall_of([](float a) { return a < 1 ? 2 * a : 1; }, 0, 6, 0.2f)));
}

TEST(PremultipliedCheck, LightWithoutCoverageDoesNotTell) {
    EXPECT_EQ(fall_of([](float a) { return a; }, 0.9f).pixels, 0u);
    EXPECT_FALSE(looks_unpremultiplied(fall_of([](float) { return 1.0f; }, 0.9f)));
}

// A rim twice as bright as the surface.
TEST(PremultipliedCheck, BrightRimsAreNoMistake) {
    EXPECT_FALSE(looks_unpremultiplied(fall_of([](float a) { return a < 1 ? 2 * a : 1; })));
}

} // namespace
} // namespace sparselens
