#include "base/error.h"
#include "deep/sanitize.h"
#include "support/ldi_samples.h"
#include "support/scratch_folder.h"
#include "support/views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sparselens {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();
const float nan = std::nanf("");

// A red plane at depth 4; pixel (1, 1), the middle of nine, is `middle`.
View view_around(const ViewPixel &middle, const ViewPixel &around = {.z = 4, .r = 0.5f, .g = 0.25f}) {
    return make_view(windows_of_size(3, 3), {0, 0},
                     [&](int x, int y) { return x == 1 && y == 1 ? middle : around; });
}

bool same(const View &a, const View &b) { return a.z == b.z && a.image.values == b.image.values; }

TEST(InvalidValues, GoodPicturesAreLeftAlone) {
    View view = random_view(windows_of_size(40, 20), {0, 0}, 1);
    view.image.values[3] = -5; // outside the gamut, but a valid colour
    view.image.values[7] = 1e30f;
    for (std::size_t i = 0; i < view.z.size(); ++i)
        if (view.image.plane(3)[i] == 0) view.z[i] = inf;
    const View before = view;
    EXPECT_FALSE(sanitize(view).any());
    EXPECT_TRUE(same(view, before));
}

TEST(InvalidValues, AColourThatIsNotFiniteIsThatOfItsNeighbours) {
    for (const float bad : {nan, inf, -inf}) {
        View view = view_around({.z = 4, .r = bad, .g = 0.125f, .a = 1});
        const InvalidValues found = sanitize(view);
        EXPECT_EQ(found.colours, 1u);
        EXPECT_EQ(found.alphas + found.depths + found.places, 0u);
        EXPECT_TRUE(same(view, view_around({.z = 4, .r = 0.5f, .g = 0.125f, .a = 1})));
    }
}

TEST(InvalidValues, FilledColoursArePremultiplied) {
    View view = view_around({.z = 4, .r = nan, .g = 0.125f, .a = 0.5f}, {.z = 4, .r = 0.2f, .a = 0.25f});
    sanitize(view);
    EXPECT_FLOAT_EQ(view.image.at(0, 1, 1), 0.4f);
}

TEST(InvalidValues, BadPixelsDoNotFillEachOther) {
    View view = make_view(windows_of_size(3, 1), {0, 0},
                          [&](int x, int) { return ViewPixel{.z = 4, .r = x == 2 ? 0.5f : nan}; });
    EXPECT_EQ(sanitize(view).colours, 2u);
    EXPECT_EQ(view.image.at(0, 1, 0), 0.5f);
    EXPECT_EQ(view.image.at(0, 0, 0), 0.0f); // its only neighbour was bad too
}

TEST(InvalidValues, AlphaIsClampedAndCountedBeyondRounding) {
    for (const auto &[bad, good, counted] : {std::tuple{1.5f, 1.0f, 1u},
                                             {-0.5f, 0.0f, 1u},
                                             {inf, 1.0f, 1u},
                                             {1.005f, 1.0f, 0u},
                                             {-0.005f, 0.0f, 0u},
                                             {nan, 0.75f, 1u}}) {
        View view = view_around({.z = 4, .a = bad}, {.z = 4, .a = 0.75f});
        EXPECT_EQ(sanitize(view).alphas, counted) << bad;
        EXPECT_EQ(view.image.at(3, 1, 1), good) << bad;
    }
}

TEST(InvalidValues, ABadDepthIsThatOfANeighbour) {
    for (const float bad : {nan, -1.0f, -inf}) {
        View view = view_around({.z = bad});
        EXPECT_EQ(sanitize(view).depths, 1u);
        EXPECT_EQ(view.z[4], 4) << "never a mean: that would be a surface that is not there";
    }
}

TEST(InvalidValues, DepthZeroSaysThatNothingWasHit) {
    for (const float nothing : {0.0f, -0.0f, 1e-40f, std::numeric_limits<float>::denorm_min()}) {
        View view = view_around({.z = nothing});
        EXPECT_FALSE(sanitize(view).any());
        EXPECT_EQ(view.z[4], inf);
    }
    View view = view_around({.z = std::numeric_limits<float>::min()});
    sanitize(view);
    EXPECT_EQ(view.z[4], std::numeric_limits<float>::min());
}

TEST(InvalidValues, WithoutCoverageAnyDepthDoes) {
    for (const float z : {nan, -1.0f, 0.0f, 3.0f}) {
        View view = view_around({.z = z, .a = 0});
        EXPECT_FALSE(sanitize(view).any());
        EXPECT_EQ(view.z[4], inf);
    }
}

// Fire, for example.
TEST(InvalidValues, LightWithoutCoverageKeepsItsDepth) {
    View view = view_around({.z = 3, .g = 2, .a = 0});
    EXPECT_FALSE(sanitize(view).any());
    EXPECT_EQ(view.z[4], 3);
    View nowhere = view_around({.z = nan, .g = 2, .a = 0});
    EXPECT_FALSE(sanitize(nowhere).any());
    EXPECT_EQ(nowhere.z[4], inf);
}

TEST(InvalidValues, MostDepthsBadIsAnotherConvention) {
    View view = make_view(windows_of_size(4, 1), {0, 0},
                          [](int x, int) { return ViewPixel{.z = x < 2 ? -3.0f : 4.0f}; });
    view.name = "x.exr";
    const std::string what = what_of<Error>([&] { sanitize(view); });
    EXPECT_EQ(what,
              "x.exr: depth -3 in pixel 0,0 is not a number above 0: `depth` says what the channel holds "
              "(negative: the z of a camera that looks along -z), `depth_channel` which channel is read");
}

TEST(InvalidValues, InDeepPicturesTheNeighbourNearestInDepthFills) {
    const TestSample front{.z = 2, .colour = 0.5f, .alpha = 0.5f}, back{.z = 8, .colour = 0.25f};
    Ldi ldi = ldi_of({{front, back}, {front, {.z = 7.5f, .colour = nan}}, {front, back}});
    EXPECT_EQ(sanitize(ldi, "x").colours, 3u); // R, G and B
    EXPECT_EQ(ldi.values[0][3], 0.25f);
    EXPECT_EQ(ldi.values[0][2], 0.5f);
}

TEST(InvalidValues, PlacesAndWeightsOfADeepPicture) {
    Ldi ldi = ldi_of({{{.z = 2, .weight = -1, .dx = 7, .dy = nan}, {.z = 3, .weight = nan, .dx = -9}},
                      {{.z = 2, .z_back = nan, .weight = 2, .dx = 0.5f, .dy = -0.5f}}});
    EXPECT_EQ(sanitize(ldi, "x").places, 6u);
    EXPECT_EQ(ldi.dx, (std::vector<float>{0.5f, -0.5f, 0.5f}));
    EXPECT_EQ(ldi.dy, (std::vector<float>{0, 0, -0.5f}));
    EXPECT_EQ(ldi.weight, (std::vector<float>{1, 1, 2}));
    EXPECT_EQ(ldi.z_back, (std::vector<float>{2, 3, 2}));
}

TEST(InvalidValues, AreSaidInOneLine) {
    EXPECT_EQ(
        (InvalidValues{.colours = 2, .depths = 1}).text(),
        "2 colours that are not finite, 1 depth that is not above 0: replaced from neighbouring pixels");
    EXPECT_EQ((InvalidValues{.alphas = 2}).text(),
              "2 alphas outside 0..1: replaced from neighbouring pixels, alpha clamped");
}

TEST(InvalidValues, ImagesNeedADepthOnEitherSideOfTheCamera) {
    Ldi ldi = ldi_of({{{.z = 1}, {.z = 2}, {.z = 3}, {.z = 4}}});
    ldi.image_z = {-3, 0, nan, inf};
    EXPECT_EQ(sanitize(ldi, "ldi").places, 2u);
    EXPECT_EQ(ldi.image_z, (std::vector<float>{-3, 2, 3, inf}));
}

} // namespace
} // namespace sparselens
