#include "deep/checks/flicker.h"
#include "lens/photograph.h"

#include <gtest/gtest.h>

#include <functional>

namespace sparselens {
namespace {

constexpr int width = 10, height = 10;

// `colour` and `disparity` of the i-th pixel.
View frame(const std::function<float(int i)> &colour, const std::function<double(int i)> &disparity) {
    View view{"frame", Image(windows_of_size(width, height), {{"R"}, {"G"}, {"B"}}), {}};
    for (int i = 0; i < width * height; ++i) {
        for (std::size_t k = 0; k < 3; ++k) view.image.plane(k)[std::size_t(i)] = colour(i);
        view.z.push_back(float(depth_of_disparity(disparity(i))));
    }
    return view;
}

TEST(Flicker, IsTheMedianChangeWhereThePictureStandsStill) {
    const auto still = [](int) { return 0.5f; };
    const auto moves = [](int i) { return i < 40 ? 0.5f : 0.9f; };
    Flicker flicker;
    EXPECT_EQ(flicker.since_last(frame(still, [](int) { return 0.5; })), 0);
    // Fifteen of the 40 pixels that stand still keep their depth.
    EXPECT_NEAR(flicker.since_last(frame(moves, [](int i) { return i < 15   ? 0.5
                                                                   : i < 40 ? 0.6
                                                                            : 0.9; })),
                0.1, 1e-6);
}

TEST(Flicker, IsNotToldWithoutAStillPicture) {
    Flicker flicker;
    EXPECT_EQ(flicker.since_last(frame([](int) { return 0.5f; }, [](int) { return 0.5; })), 0);
    EXPECT_EQ(flicker.since_last(frame([](int i) { return i < 9 ? 0.5f : 0.9f; }, [](int) { return 0.7; })),
              0);
    View smaller{"frame", Image(windows_of_size(2, 1), {{"R"}, {"G"}, {"B"}}), {1, 1}};
    EXPECT_EQ(flicker.since_last(std::move(smaller)), 0);
}

} // namespace
} // namespace sparselens
