#include "lens/photograph.h"
#include "lens/thin_lens.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

TEST(Photograph, HasTheCircleOfConfusionThatItsDisparitiesSay) {
    constexpr double blur = 40, focal_px = 1920;
    for (const double focus : {0.0, 0.3, 1.0})
        for (const double disparity : {0.0, 0.25, 1.0}) {
            const ThinLens lens{.radius = radius_of_blur(blur, focal_px),
                                .focal_px = focal_px,
                                .focus = depth_of_disparity(focus)};
            EXPECT_NEAR(circle_of_confusion(lens, depth_of_disparity(disparity)), blur * (focus - disparity),
                        1e-10);
            EXPECT_NEAR(disparity_of_depth(depth_of_disparity(disparity)), disparity, 1e-15);
        }
}

} // namespace
} // namespace sparselens
