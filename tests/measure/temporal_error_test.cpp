// The steadiness of sequences: closed forms, for chosen tone-mapped values.
#include "measure/figures_text.h"
#include "measure/temporal_error.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

namespace sparselens {
namespace {

// The scene-linear value whose tone-mapped value is v, in [0, 1).
float linear(double v) {
    const double x = std::pow(v, 2.2);
    return float(x / (1 - x));
}

// One row of grey pixels with these tone-mapped values.
Image frame(const std::vector<double> &tones) {
    Image image(windows_of_size(int(tones.size()), 1), rgba_channels());
    for (std::size_t i = 0; i < tones.size(); ++i)
        for (std::size_t c = 0; c < 4; ++c) image.plane(c)[i] = c == 3 ? 1 : linear(tones[i]);
    return image;
}

TEST(TemporalError, EvenChangeIsSteadyAndAPopIsNot) {
    TemporalError error;
    for (int t = 0; t < 5; ++t) // still, even change, a flicker of 0.03, a pop of 0.2
        error.add(frame({0.5, 0.2 + 0.1 * t, t == 2 ? 0.515 : 0.5, t < 3 ? 0.3 : 0.5}));
    const TemporalFigures figures = error.figures();
    EXPECT_EQ(figures.frames, 5u);
    EXPECT_EQ(figures.pixels, 4u);
    EXPECT_EQ(figures.image.above[0], 2u);
    EXPECT_EQ(figures.image.above[1], 1u);
    EXPECT_NEAR(figures.image.largest, 0.2, 1e-6);
    EXPECT_FALSE(figures.reference || figures.psnr_change);
}

TEST(TemporalError, ChangesAreComparedNotValues) {
    TemporalError same, other;
    for (int t = 0; t < 4; ++t) {
        const Image reference = frame({0.2 + 0.1 * t, 0.4});
        const Image lighter = frame({0.3 + 0.1 * t, 0.5}), slower = frame({0.2 + 0.05 * t, 0.4});
        same.add(lighter, &reference);
        other.add(slower, &reference);
    }
    EXPECT_GT(*same.figures().psnr_change, 120);
    // One of two pixels changes by 0.05 less than the reference in each step.
    EXPECT_NEAR(*other.figures().psnr_change, -10 * std::log10(0.05 * 0.05 / 2), 1e-3);
    EXPECT_LT(other.figures().reference->largest, 1e-6);
}

TEST(TemporalError, LeavesOutWhatIsNotFiniteInAnyFrame) {
    TemporalError error;
    for (int t = 0; t < 4; ++t) {
        Image image = frame({0.5, t % 2 == 0 ? 0.9 : 0.1});
        if (t == 3) image.plane(1)[1] = std::numeric_limits<float>::infinity();
        error.add(image);
    }
    EXPECT_EQ(error.figures().nonfinite, 1u);
    EXPECT_EQ(error.figures().image.largest, 0);
}

TEST(TemporalError, AsText) {
    TemporalError error;
    for (int t = 0; t < 3; ++t) {
        const Image image = frame({0.5, t == 1 ? 0.6 : 0.5});
        error.add(image, &image);
    }
    const auto json = nlohmann::json::parse(temporal_as_json(error.figures()));
    EXPECT_EQ(json["frames"], 3);
    EXPECT_EQ(json["above_0.05"], 1);
    EXPECT_EQ(json["reference"]["above_0.02"], 1);
    EXPECT_TRUE(json["psnr_change"].is_null()); // infinite
    EXPECT_NE(temporal_as_table(error.figures()).find("above_0.05         1          1"), std::string::npos)
        << temporal_as_table(error.figures());
}

} // namespace
} // namespace sparselens
