// Tests that the whole chain from views to the picture is as good as floors.h says.
#include "base/subpixels.h"
#include "deep/mixed_pixels.h"
#include "deep/tidy.h"
#include "deep/view_samples.h"
#include "dof/gather_picture.h"
#include "dof/lens/tile_plan.h"
#include "io/exr/exr_flat.h"
#include "lab/tests/floors/floors.h"
#include "lab/tests/support/traced.h"
#include "lab/trace/deep.h"
#include "measure/image_error.h"
#include "warp/warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace sparselens {
namespace {

using namespace lab;

// The rows and columns along the border that are measured apart.
constexpr int border_px = 16;

Floor measured(const char *picture, const Image &image, const Image &reference) {
    const Windows &windows = reference.windows;
    const Imath::Box2i inside(windows.data.min + Imath::V2i(border_px),
                              windows.data.max - Imath::V2i(border_px));
    std::vector<std::uint8_t> bits(windows.pixels());
    for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = inside.intersects(windows.pixel(i)) ? 1 : 2;
    const std::vector<ErrorFigures> figures = image_error(image, reference, bits, 2);
    return {picture, figures[1].psnr_tonemapped, figures[2].psnr_tonemapped,
            double(std::ranges::min(image.plane(3)))};
}

void expect_decibels(double now, double floor) {
    EXPECT_GE(now, floor - floor_below)
        << "worse than floors.h: mend it, or lower the floor for a reason in docs/tolerances.md, section 7";
    EXPECT_LE(now, floor + floor_above)
        << "better than floors.h: write it down with lab/tests/floors/write.sh BIN_DIR";
}

// write.sh reads the line that this prints.
void expect_floor(const std::string &picture, const Image &image, const Image &reference) {
    SCOPED_TRACE(picture);
    const Floor now = measured(picture.c_str(), image, reference);
    std::printf("    {\"%s\", %.2f, %.2f, %.4f},\n", now.picture, now.inside, now.border, now.least_alpha);
    const Floor *floor = std::ranges::find(floors, picture, &Floor::picture);
    ASSERT_NE(floor, std::end(floors)) << "a new picture: lab/tests/floors/write.sh BIN_DIR";
    expect_decibels(now.inside, floor->inside);
    expect_decibels(now.border, floor->border);
    EXPECT_NEAR(now.least_alpha, floor->least_alpha, 1e-4); // rounding of float sums of weights: section 3
}

Image gather(const Ldi &ldi, const SceneCamera &scene,
             const LensGatherOptions &by = {.quality = Quality::final}) {
    Progress silent;
    PictureOptions options;
    options.gather.lens = by;
    const Imath::Box2i &window = scene.settings.windows.data;
    return gather_picture(ldi, scene.settings.lens, window, window, options, silent);
}

std::vector<View> views_of(const SceneCamera &scene, int samples = 16) {
    std::vector<View> views = scene.five_views(samples);
    for (View &view : views) repair_edge_depths(view); // as when they are read
    return views;
}

Ldi warped(const std::vector<View> &views, const SceneCamera &scene, int across = 1) {
    Progress silent;
    const ThinLens &lens = scene.settings.lens;
    return warp(views,
                {.focal_px = lens.focal_px, .radius = lens.radius, .focus = lens.focus, .across = across},
                silent);
}

// Five views of twice the size, at normal quality.
constexpr int twice = 2;
Image doubled(const SceneCamera &scene) {
    const Ldi ldi = warped(views_of(scene, 16 / (twice * twice)), scene, twice);
    return mean_of_subpixels(gather(ldi, scene, {.across = twice}), {twice}, {{0, 0}, {239, 134}});
}

Image reference_of(const std::string &name, const SceneCamera &scene) {
    const std::string file = std::string(SPARSELENS_REFERENCES_DIR) + "/" + name + ".exr";
    return rgba_over(read_flat_exr(file).image, scene.settings.windows, file);
}

class Floors : public testing::TestWithParam<const char *> {};

TEST_P(Floors, Hold) {
    const std::string name = GetParam();
    const SceneCamera scene(name, 240, 135);
    const Image reference = reference_of(name, scene);
    const std::vector<View> views = views_of(scene);
    const Image five = gather(warped(views, scene), scene),
                one = gather(ViewSamples(views[0], views[0].image.channels).as_ldi(), scene,
                             {.quality = Quality::final});
    expect_floor(name + " from five views", five, reference);
    expect_floor(name + " from one view", one, reference);
    if (name != "macro") return;
    const Imath::Box2i relief{{45, 27}, {195, 108}}; // it is steep, before lamps of radiance 200
    expect_floor("relief of macro", crop(five, relief), crop(reference, relief));
}

constexpr auto name_of = [](const auto &of) {
    std::string name = of.param;
    std::erase(name, '-');
    return name;
};
INSTANTIATE_TEST_SUITE_P(All, Floors,
                         testing::Values("fence", "grass", "mist", "mirror", "plane-mirror", "element",
                                         "macro"),
                         name_of);

class DoubledFloors : public testing::TestWithParam<const char *> {};

TEST_P(DoubledFloors, Hold) {
    const std::string name = GetParam();
    const SceneCamera scene(name, 240, 135);
    const SceneCamera large(name, 240 * twice, 135 * twice);
    expect_floor(name + " doubled", doubled(large), reference_of(name, scene));
}

INSTANTIATE_TEST_SUITE_P(All, DoubledFloors, testing::Values("fence", "grass", "element", "macro"), name_of);

// Focused so that each tile is gathered in cells.
SceneCamera far_out_of_focus(int times) {
    SceneCamera scene("fence", 240 * times, 135 * times);
    scene.settings.lens.radius = 0.15;
    scene.settings.lens.focus = 0.5;
    return scene;
}

bool all_in_cells(const Ldi &ldi, const SceneCamera &scene, const LensGatherOptions &options) {
    const GatherScene prepared = prepare(ldi, scene.settings.lens, scene.settings.windows.data, options);
    TilePlan plan(prepared, options, scene.settings.windows);
    for (std::size_t tile = 0; tile < plan.count(); ++tile)
        if (!plan.tile(tile)->cells) return false;
    return true;
}

TEST(CellFloors, HoldForFence) {
    const SceneCamera scene = far_out_of_focus(1);
    const Ldi ldi = warped(views_of(scene), scene);
    EXPECT_TRUE(all_in_cells(ldi, scene, {.quality = Quality::final}));
    const Image reference = reference_of("fence-far-out-of-focus", scene);
    expect_floor("fence in cells", gather(ldi, scene), reference);
    expect_floor("fence in cells, doubled", doubled(far_out_of_focus(twice)), reference);
}

TEST(DeepFloors, HoldForMist) {
    const SceneCamera scene("mist", 240, 135);
    Progress silent;
    const Ldi ldi = tidy(render_peeled(scene.tracer, scene.settings, 4, 16, 1, silent));
    expect_floor("mist as a deep file", gather(ldi, scene), reference_of("mist", scene));
}

} // namespace
} // namespace sparselens
