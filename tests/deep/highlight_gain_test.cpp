// Lights that are brightened before the gather: closed forms.
#include "deep/recolor.h"
#include "support/ldi_samples.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

const HighlightGain by{.gain = 5, .threshold = 2, .knee = 4};

TEST(HighlightGain, SetsInOverTheKnee) {
    EXPECT_EQ(highlight_factor(by, 0), 1);
    EXPECT_EQ(highlight_factor(by, 2), 1);
    EXPECT_DOUBLE_EQ(highlight_factor(by, 4), 3); // the middle of the knee: half of the growth
    EXPECT_EQ(highlight_factor(by, 6), 5);
    EXPECT_EQ(highlight_factor(by, 1e9), 5);
    for (double y = 0; y < 8; y += 0.01) // no step, and the order of brightness is kept
        EXPECT_NEAR(highlight_factor(by, y + 0.01), highlight_factor(by, y), 0.02) << y;
}

TEST(HighlightGain, GoesByLightWithoutCoverageAndKeepsHue) {
    // R, G, B are colour, colour / 2, colour / 4; both samples have the same unpremultiplied colour.
    Ldi ldi =
        ldi_of({{{.z = 1, .colour = 20, .alpha = 1}}, {{.z = 1, .colour = 5, .alpha = 0.25f}}, {{.z = 1}}});
    const Ldi before = ldi;
    raise_highlights(ldi, by);
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_FLOAT_EQ(ldi.values[k][0], 5 * before.values[k][0]);
        EXPECT_FLOAT_EQ(ldi.values[k][1], 5 * before.values[k][1]);
        EXPECT_EQ(ldi.values[k][2], before.values[k][2]); // below the threshold
    }
    EXPECT_EQ(ldi.values[3], before.values[3]);
}

} // namespace
} // namespace sparselens
