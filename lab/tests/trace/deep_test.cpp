#include "deep/flatten.h"
#include "deep/tidy.h"
#include "lab/tests/trace/small_scenes.h"
#include "lab/trace/deep.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

namespace sparselens::lab {
namespace {

Progress silent;
constexpr float inf = std::numeric_limits<float>::infinity();

// A red half-covering sheet on the left, a blue wall behind everything, sky behind the wall.
Scene sheet_and_wall() {
    Scene scene;
    scene.translucent = true;
    scene.sky = {0, 1, 0};
    scene.quads = {facing_wall(8, blue_light), facing_quad(-9, -9, 0, 9, 4, half_red)};
    return scene;
}

std::vector<float> depths(const Ldi &ldi, std::size_t pixel) {
    return {ldi.z.begin() + std::ptrdiff_t(ldi.pixel(pixel).from),
            ldi.z.begin() + std::ptrdiff_t(ldi.pixel(pixel).to)};
}

TEST(RenderPeeled, SurfacesComeInOrder) {
    const RenderSettings settings = settings_of_size(8, 4);
    const Ldi ldi = render_peeled(Tracer(sheet_and_wall()), settings, 5, 4, 1, silent);
    ASSERT_EQ(ldi.begin.size(), 33u);
    EXPECT_EQ(depths(ldi, 0), (std::vector<float>{4, 8, inf}));
    EXPECT_EQ(depths(ldi, 7), (std::vector<float>{8, inf}));
    EXPECT_FLOAT_EQ(ldi.values[0][0], 0.5f); // premultiplied
    EXPECT_FLOAT_EQ(ldi.values[3][0], 0.5f);
    EXPECT_FLOAT_EQ(ldi.values[2][1], 1);
    EXPECT_FLOAT_EQ(ldi.values[1][2], 1);
    EXPECT_TRUE(ldi.z_back.empty());
}

TEST(RenderPeeled, OnlyTheNearestAreKept) {
    const RenderSettings settings = settings_of_size(8, 4);
    const Tracer tracer(sheet_and_wall());
    EXPECT_EQ(depths(render_peeled(tracer, settings, 1, 1, 1, silent), 0), (std::vector<float>{4}));
    EXPECT_EQ(depths(render_peeled(tracer, settings, 2, 1, 1, silent), 0), (std::vector<float>{4, 8}));
}

// The first layer shows what the centre view sees, and no layer mixes two surfaces: the sheet ends inside pixel 4.
TEST(RenderPeeled, SilhouettesStayUnmixed) {
    RenderSettings settings = settings_of_size(9, 3);
    const Ldi ldi = render_peeled(Tracer(sheet_and_wall()), settings, 3, 16, 1, silent);
    for (std::size_t i = 0; i < ldi.samples(); ++i) {
        const float expected = ldi.z[i] == 4 ? 0.5f : 1;
        EXPECT_FLOAT_EQ(ldi.values[3][i], expected);
        EXPECT_FLOAT_EQ(ldi.values[0][i] + ldi.values[1][i] + ldi.values[2][i], expected);
    }
}

TEST(RenderPeeled, FirstDepthIsTheCentreViews) {
    const RenderSettings settings = settings_of_size(64, 36);
    const Tracer tracer(build_scene("grass"));
    const Image view = render_view(tracer, settings, {0, 0}, 1, 1, silent);
    const Ldi ldi = render_peeled(tracer, settings, 3, 1, 1, silent);
    for (std::size_t pixel = 0; pixel < settings.windows.pixels(); ++pixel) {
        const std::vector<float> z = depths(ldi, pixel);
        EXPECT_EQ(z.front(), view.plane(4)[pixel]);
        EXPECT_TRUE(std::is_sorted(z.begin(), z.end()));
        EXPECT_FLOAT_EQ(ldi.values[0][ldi.pixel(pixel).front()], view.plane(0)[pixel]);
    }
}

// A wall that is fully hidden from the centre appears in its own stratum: the see-through fault.
TEST(RenderStrata, SeeWhatIsHidden) {
    const RenderSettings settings = settings_of_size(8, 4);
    Scene scene;
    scene.quads = {facing_wall(4, white_light), facing_wall(12, blue_light)};
    const Ldi ldi = render_strata(Tracer(scene), settings, 4, 4, 1, silent);
    EXPECT_EQ(depths(ldi, 5),
              (std::vector<float>{4, 12, inf})); // 1/12 = 1/3 of 1/4: third interval; sky: last
    EXPECT_FLOAT_EQ(ldi.values[0][0], 1);
    EXPECT_FLOAT_EQ(ldi.values[0][1], 0);
    EXPECT_FLOAT_EQ(ldi.values[2][1], 1);
}

// Intervals are equal in 1 / z from the nearest surface, at 4: 2 strata part at 8.
TEST(RenderStrata, PartAtEqualDisparity) {
    const RenderSettings settings = settings_of_size(8, 4);
    for (const double z : {7.9, 8.1}) {
        Scene scene;
        scene.quads = {facing_wall(4, white_light), facing_wall(z, blue_light)};
        const std::vector<float> expected =
            z < 8 ? std::vector<float>{4, inf} : std::vector<float>{4, float(z)};
        EXPECT_EQ(depths(render_strata(Tracer(scene), settings, 2, 1, 1, silent), 0), expected);
    }
}

TEST(RenderStrata, EdgesCoverInPart) {
    const RenderSettings settings = settings_of_size(9, 3);
    Scene scene;
    scene.quads = {facing_quad(-9, -9, 0, 9, 4, white_light)}; // to the middle of pixel 4
    const Ldi ldi = render_strata(Tracer(scene), settings, 3, 16, 1, silent);
    const std::size_t first = ldi.pixel(4).front();
    ASSERT_EQ(ldi.pixel(4).size(), 2u);
    EXPECT_FLOAT_EQ(ldi.values[3][first], 0.5f);
    EXPECT_FLOAT_EQ(ldi.values[3][first + 1], 1); // the sky as if the lamp were not there
    EXPECT_EQ(ldi.z[first], 4);
}

TEST(RenderStrata, OneStratumIsTheCentreView) {
    const RenderSettings settings = settings_of_size(64, 36);
    const Tracer tracer(build_scene("grass"));
    const Image view = render_view(tracer, settings, {0, 0}, 9, 1, silent);
    const Ldi ldi = render_strata(tracer, settings, 1, 9, 1, silent);
    ASSERT_EQ(ldi.samples(), settings.windows.pixels());
    for (std::size_t channel = 0; channel < 4; ++channel)
        for (std::size_t i = 0; i < ldi.samples(); ++i)
            EXPECT_NEAR(ldi.values[channel][i], view.plane(channel)[i], 1e-5);
    for (std::size_t i = 0; i < ldi.samples(); ++i) EXPECT_EQ(ldi.z[i], view.plane(4)[i]);
}

// Hidden surfaces are missing; where the sheet ends inside a pixel, both surfaces exist.
TEST(RenderVisible, IsWhatTheSamplesSee) {
    const RenderSettings settings = settings_of_size(9, 3);
    Scene scene = sheet_and_wall();
    const Ldi ldi = render_visible(Tracer(scene), settings, 16, 1, silent);
    EXPECT_EQ(depths(ldi, 0), (std::vector<float>{4, 8})); // not the sky behind the wall
    EXPECT_EQ(depths(ldi, 4), (std::vector<float>{4, 8}));
    EXPECT_EQ(depths(ldi, 8), (std::vector<float>{8}));
    EXPECT_FLOAT_EQ(ldi.values[3][ldi.pixel(0).from], 0.5f);
    EXPECT_FLOAT_EQ(ldi.values[3][ldi.pixel(4).from], 0.25f);
    EXPECT_FLOAT_EQ(ldi.values[0][ldi.pixel(4).from], 0.25f);
    scene.quads[1].material = blue_light; // opaque: the wall behind it is hidden
    EXPECT_EQ(depths(render_visible(Tracer(scene), settings, 16, 1, silent), 0), (std::vector<float>{4}));
}

// Surfaces that cross in a pixel, the sky between thin bars, partial coverage: flattened, all equal the view.
TEST(RenderVisible, FlattenedIsTheCentreView) {
    const RenderSettings settings = settings_of_size(64, 36);
    for (const char *scene : {"fence", "grass", "mist", "element"}) {
        const Tracer tracer(build_scene(scene));
        const Image view = render_view(tracer, settings, {0, 0}, 16, 1, silent);
        const Image flat = flatten(tidy(render_visible(tracer, settings, 16, 1, silent)));
        for (std::size_t channel = 0; channel < 4; ++channel)
            for (std::size_t i = 0; i < settings.windows.pixels(); ++i)
                ASSERT_NEAR(flat.plane(channel)[i], view.plane(channel)[i], 2e-4) << scene << ' ' << i;
    }
}

// Slabs are samples with their whole extent: alpha 1 - exp(-optical depth), overlapping, after the surfaces.
TEST(RenderDeep, SlabsAreVolumeSamples) {
    Scene scene = sheet_and_wall();
    scene.slabs = {{2, 6, 0.25, {1, 0.5f, 0}}, {5, 7, 0.5, {0, 0, 1}}};
    const RenderSettings settings = settings_of_size(8, 4);
    const Tracer tracer(scene);
    for (const Ldi &ldi : {render_peeled(tracer, settings, 2, 1, 1, silent),
                           render_strata(tracer, settings, 2, 1, 1, silent)}) {
        const std::size_t end = ldi.pixel(0).to;
        ASSERT_GE(end, 3u);
        EXPECT_EQ(ldi.z[end - 2], 2);
        EXPECT_EQ(ldi.z_back[end - 2], 6);
        EXPECT_EQ(ldi.z[end - 1], 5);
        EXPECT_EQ(ldi.z_back[end - 1], 7);
        EXPECT_EQ(ldi.z_back[0], ldi.z[0]);
        EXPECT_FLOAT_EQ(ldi.values[3][end - 2], float(1 - std::exp(-1)));
        EXPECT_FLOAT_EQ(ldi.values[1][end - 2], float(0.5 * (1 - std::exp(-1))));
        EXPECT_GT(ldi.z[end - 3], ldi.z[end - 2]); // untidied
    }
}

// Tidied and flattened, the peeled mist equals the centre view of the mist: slabs, sheets and backdrop.
TEST(RenderDeep, FlattenedMistIsTheCentreView) {
    const RenderSettings settings = settings_of_size(64, 36);
    const Tracer tracer(build_scene("mist"));
    const Image view = render_view(tracer, settings, {0, 0}, 1, 1, silent);
    const Image flat = flatten(tidy(render_peeled(tracer, settings, 8, 1, 1, silent)));
    for (std::size_t channel = 0; channel < 4; ++channel)
        for (std::size_t i = 0; i < settings.windows.pixels(); ++i)
            EXPECT_NEAR(flat.plane(channel)[i], view.plane(channel)[i], 1e-5);
}

TEST(RenderDeep, ThreadsDoNotMatter) {
    RenderSettings settings = settings_of_size(40, 23);
    settings.light = Light::area;
    const Tracer tracer(build_scene("fence"));
    const auto both = [&] {
        return std::pair(render_peeled(tracer, settings, 3, 3, 1, silent).values,
                         render_strata(tracer, settings, 3, 3, 1, silent).values);
    };
    const auto many = both();
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(many, both());
}

} // namespace
} // namespace sparselens::lab
