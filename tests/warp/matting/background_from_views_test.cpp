#include "support/views.h"
#include "warp/matting/thin_structures.h"
#include "warp/silhouettes.h"

#include <gtest/gtest.h>

#include <vector>

namespace sparselens {
namespace {

constexpr double focal_px = 100, scale = 20; // R F
constexpr int width = 40;

// A wall at depth 10 whose red says which point of it a pixel shows, before which a card at depth 2 covers columns
// of the centre view. The cameras stand so far apart that the card moves by 10 pixels and the wall by 2.
struct Scene {
    std::vector<ViewSamples> samples;
    std::vector<ViewMapping> mappings;
    std::vector<View> views;

    explicit Scene(const std::vector<double> &cameras, float alpha = 1) {
        for (const double camera : cameras)
            views.push_back(make_view(windows_of_size(width, 9), {camera, 0}, [&](int x, int) {
                const double card = x + 0.5 + focal_px * camera / 2;
                if (card > 15 && card < 20) return ViewPixel{.z = 2, .g = 1};
                const double wall = x + 0.5 + focal_px * camera / 10;
                return ViewPixel{.z = 10, .r = float(wall) * alpha, .a = alpha};
            }));
        for (const View &view : views) {
            samples.emplace_back(view, view.image.channels);
            mappings.emplace_back(view.position, focal_px, view.image.windows);
        }
    }
    std::optional<Imath::V3d> behind(std::size_t own, int x, double depth = 2) const {
        return BackgroundFromViews(samples, mappings, own, scale).colour_behind(Position(x, 4), depth, 1);
    }
};

TEST(BackgroundFromViews, ShowWhatACardHides) {
    const Scene scene({0, 0.2});
    const auto colour = scene.behind(0, 17); // the card's column 17; the wall's disparity is 2
    ASSERT_TRUE(colour);
    EXPECT_NEAR(colour->x, 17.5, 1e-5);
    EXPECT_EQ(colour->y, 0);
    const auto back = scene.behind(1, 7); // the same card in the other view
    ASSERT_TRUE(back);
    EXPECT_NEAR(back->x, 9.5, 1e-5);
}

TEST(BackgroundFromViews, AreMeans) {
    const Scene one({0, 0.2}), two({0, 0.2, 0.25});
    ASSERT_TRUE(two.behind(0, 17));
    EXPECT_NEAR(two.behind(0, 17)->x, (17.5 + 17.5) / 2, 0.5); // the third view is half a pixel off
    EXPECT_NE(two.behind(0, 17)->x, one.behind(0, 17)->x);
}

TEST(BackgroundFromViews, SayNothingWhereTheSurfaceIsMixedHiddenOrOutside) {
    const Scene scene({0, 0.2});
    EXPECT_FALSE(Scene({0}).behind(0, 17));            // no other view
    EXPECT_FALSE(scene.behind(0, 9));                  // the card of the other view is there
    EXPECT_FALSE(scene.behind(0, 11));                 // and beside this pixel
    EXPECT_FALSE(scene.behind(0, 17, 5));              // nothing lies at that depth
    EXPECT_FALSE(scene.behind(0, 1));                  // outside of the other view
    EXPECT_FALSE(Scene({0, 0.2}, 0.5f).behind(0, 17)); // not opaque
}

TEST(BackgroundFromViews, LookPastWhatLiesNearerThanAllTheyShowThere) {
    const Scene scene({0, 0.2}), veil({0, 0.2}, 0);
    const auto past = [](const Scene &of, int x, double depth) {
        return BackgroundFromViews(of.samples, of.mappings, 0, scale).see_past(Position(x, 4), depth);
    };
    EXPECT_TRUE(past(scene, 17, 5));  // the wall's disparity is 2
    EXPECT_FALSE(past(scene, 17, 2)); // the wall itself
    EXPECT_FALSE(past(scene, 17, 9)); // the card is beside it
    EXPECT_FALSE(past(scene, 12, 5)); // the card hides it
    EXPECT_FALSE(past(scene, 1, 5));  // outside of the other view
    EXPECT_FALSE(past(veil, 17, 5));  // that may not have been rendered
    EXPECT_FALSE(past(Scene({0}), 17, 5));
}

// A card with a glint on its last pixel, beside which the centre view shows a lamp at depth 10, before the sky: the glint
// is no part of the lamp if the other view shows the sky behind the card.
TEST(BackgroundFromViews, AGlintIsNoPartOfALampThatIsNotBehindIt) {
    for (const bool lamp_behind : {false, true}) {
        std::vector<View> views;
        std::vector<ViewSamples> samples;
        std::vector<ViewMapping> mappings;
        for (const double camera : {0.0, 0.2})
            views.push_back(make_view(windows_of_size(width, 9), {camera, 0}, [&](int x, int) {
                const double card = x + 0.5 + focal_px * camera / 2, lamp = x + 0.5 + focal_px * camera / 10;
                if (card > 15 && card < 20) return ViewPixel{.z = 2, .r = card > 19 ? 50.045f : 0.05f};
                const bool shines = camera == 0 ? lamp > 20 && lamp < 22 : lamp_behind && lamp > 18;
                return ViewPixel{.z = shines ? 10.0f : 1000.0f, .r = shines ? 500.0f : 0.3f};
            }));
        for (const View &view : views) {
            samples.emplace_back(view, view.image.channels);
            mappings.emplace_back(view.position, focal_px, view.image.windows);
        }
        const BackgroundFromViews others(samples, mappings, 0, scale);
        ViewSamples own(views[0], views[0].image.channels);
        separate_silhouettes(own, scale, 0.5, {}, &others);
        const Ldi ldi = own.as_ldi();
        const SampleRange glint = ldi.pixel(std::size_t(4 * width + 19));
        EXPECT_EQ(glint.size(), lamp_behind ? 2u : 1u);
        EXPECT_EQ(ldi.values[0][glint.front()] > 40, !lamp_behind);
    }
}

// A dark card at depth 2 before a dark wall at depth 10. In the centre view, the card's last pixel and the wall's first
// one are bright: by a lit edge of the card, or by a lamp on the wall.
struct BrightEdge {
    std::vector<ViewSamples> samples;
    std::vector<ViewMapping> mappings;
    std::vector<View> views;

    explicit BrightEdge(bool lamp) {
        for (const double camera : {0.0, 0.2})
            views.push_back(make_view(windows_of_size(width, 9), {camera, 0}, [&](int x, int) {
                const double card = x + 0.5 + focal_px * camera / 2, wall = x + 0.5 + focal_px * camera / 10;
                if (card > 15 && card < 20)
                    return ViewPixel{.z = 2, .r = camera == 0 && card > 19 ? 3.0f : 0.05f};
                const bool bright = (lamp || camera == 0) && wall > 20 && wall < 21;
                return ViewPixel{.z = 10, .r = bright ? 3.0f : 0.3f};
            }));
        for (const View &view : views) {
            samples.emplace_back(view, view.image.channels);
            mappings.emplace_back(view.position, focal_px, view.image.windows);
        }
    }
    // The light in the last pixel of the card.
    std::optional<Mixture> light(bool by_both) const {
        const BackgroundFromViews others(samples, mappings, 0, scale);
        return light_between_strands(SamplesAround(samples[0], scale), 19, 4, 0.5, 1,
                                     by_both ? &others : nullptr);
    }
};

TEST(BackgroundFromViews, TellALitEdgeFromALampBehindIt) {
    EXPECT_FALSE(BrightEdge(false).light(true));
    for (const auto &light : {BrightEdge(true).light(true), BrightEdge(false).light(false)}) {
        ASSERT_TRUE(light);
        EXPECT_NEAR(light->far_depth, 2, 1e-5);
    }
}

} // namespace
} // namespace sparselens
