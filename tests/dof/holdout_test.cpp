// A picture with a holdout, compared with the closed forms of one surface in front of another.
#include "deep/flatten.h"
#include "deep/merge.h"
#include "dof/lens/lens_gather.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <limits>

namespace sparselens {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};
const std::vector<Channel> alone{{"A"}};

// Cards with these depths and coverages in the left half.
Ldi cards(const Windows &windows, const std::vector<std::pair<double, float>> &all) {
    return make_ldi(windows, alone, [&](int x, int) {
        std::vector<Sample> samples;
        if (x < windows.display_width() / 2)
            for (const auto &[z, alpha] : all) samples.push_back({z, {alpha}});
        return samples;
    });
}

TEST(Holdout, HidesWhatIsBehind) {
    const Holdout holdout(cards(windows_of_size(4, 2), {{2, 0.5f}, {4, 0.75f}, {8, 1.0f}}));
    EXPECT_EQ(holdout.passes(0, 0, 1), 1);
    EXPECT_EQ(holdout.passes(0, 0, 2), 1); // its own depth
    EXPECT_EQ(holdout.passes(0, 0, 3), 0.5);
    EXPECT_EQ(holdout.passes(0, 0, 4 * (1 + 1e-8)), 0.5); // equal up to rounding
    EXPECT_EQ(holdout.passes(1, 1, 5), 0.125);
    EXPECT_EQ(holdout.passes(1, 1, inf), 0);
    EXPECT_EQ(holdout.passes(2, 0, inf), 1);
    EXPECT_EQ(holdout.passes(-1, 0, inf), 1);
    EXPECT_EQ(holdout.passes(0, 2, inf), 1);
}

TEST(Holdout, OfAVolumeHidesByHowMuchIsInFront) {
    Ldi fog = cards(windows_of_size(2, 1), {{2, 0.75f}});
    fog.z_back = {4};
    const Holdout holdout(fog);
    EXPECT_EQ(holdout.passes(0, 0, 2), 1);
    EXPECT_NEAR(holdout.passes(0, 0, 3), 0.5, 1e-12);
    EXPECT_NEAR(holdout.passes(0, 0, 4), 0.25, 1e-12);
    EXPECT_NEAR(holdout.passes(0, 0, 5), 0.25, 1e-12);
}

Image gather(const Ldi &ldi, const Holdout *holdout) {
    Progress silent;
    return lens_gather(ldi, lens, ldi.windows.data, {.holdout = holdout}, silent);
}

// A wall far out of focus shows the edge of its holdout sharp.
TEST(Holdout, StaysSharp) {
    const Windows windows = windows_of_size(40, 8);
    const Ldi wall = make_ldi(windows, rgba_channels(), [](int, int) {
        return std::vector<Sample>{{20, {0.5f, 0.25f, 1, 1}}};
    });
    for (const auto &[z, alpha] :
         {std::pair(3.0, 1.0f), {5.0, 0.25f}, {19.0, 0.5f}, {20.0, 1.0f}, {30.0, 1.0f}}) {
        const Holdout holdout(cards(windows, {{z, alpha}}));
        const Image out = gather(wall, &holdout), free = gather(wall, nullptr);
        for (int x = 0; x < 40; ++x)
            for (std::size_t k = 0; k < 4; ++k) {
                const double passes = x < 20 && z < 20 ? 1 - double(alpha) : 1;
                EXPECT_NEAR(out.at(k, x, 4), passes * double(free.at(k, x, 4)), 1e-5) << x << " behind " << z;
            }
    }
}

TEST(Holdout, FlattensAsTheClosedForm) {
    const Windows windows = windows_of_size(2, 1);
    const Ldi ldi = make_ldi(windows, {{"Y"}, {"A"}}, [](int, int) {
        return std::vector<Sample>{{1, {0.25f, 0.5f}}, {3, {0.5f, 0.5f}}, {9, {1, 1}}};
    });
    const Image out = flatten_held_out(ldi, Holdout(cards(windows, {{2, 0.5f}, {6, 0.5f}})));
    EXPECT_FLOAT_EQ(out.at(0, 0, 0), 0.25f + 0.5f * 0.5f * 0.5f + 0.25f * 0.25f * 1);
    EXPECT_FLOAT_EQ(out.at(1, 0, 0), 0.5f + 0.5f * 0.5f * 0.5f + 0.25f * 0.25f * 1);
    EXPECT_FLOAT_EQ(out.at(0, 1, 0), flatten(ldi).at(0, 1, 0));
}

} // namespace
} // namespace sparselens
