// Tests that the whole chain from views to the picture is at least as good as floors.h says.
#include "base/subpixels.h"
#include "deep/edge_depths.h"
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
#include <string_view>

namespace sparselens {
namespace {

using namespace lab;

constexpr int border_px = 16;

Decibels decibels(const Image &image, const Image &reference) {
    const Windows &windows = reference.windows;
    const Imath::Box2i inside(windows.data.min + Imath::V2i(border_px),
                              windows.data.max - Imath::V2i(border_px));
    std::vector<std::uint8_t> bits(windows.pixels());
    for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = inside.intersects(windows.pixel(i)) ? 1 : 2;
    const std::vector<ErrorFigures> figures = image_error(image, reference, bits, 2);
    return {figures[1].psnr_tonemapped, figures[2].psnr_tonemapped};
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
    for (View &view : views) settle_edge_depths(view); // as when they are read
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

void expect_no_worse(const Decibels &now, const Decibels &measured) {
    EXPECT_GE(now.inside, measured.inside - floor_below);
    EXPECT_GE(now.border, measured.border - floor_below);
}

void expect_relief(const Image &image, const Image &reference) {
    const Imath::Box2i relief{{45, 27}, {195, 108}};
    const double now = image_error(crop(image, relief), crop(reference, relief)).front().psnr_tonemapped;
    std::printf("relief of macro %.2f\n", now);
    EXPECT_GE(now, measured_macro_relief - floor_below);
}

class Floors : public testing::TestWithParam<MeasuredScene> {};

TEST_P(Floors, Hold) {
    const MeasuredScene &measured = GetParam();
    const SceneCamera scene(measured.scene, 240, 135);
    const Image reference = reference_of(measured.scene, scene);
    const std::vector<View> views = views_of(scene);
    const Image five = gather(warped(views, scene), scene),
                one = gather(ViewSamples(views[0], views[0].image.channels).as_ldi(), scene,
                             {.quality = Quality::final, .one_view = true});
    const MeasuredScene now{measured.scene, decibels(five, reference), decibels(one, reference),
                            double(std::ranges::min(five.plane(3)))};
    std::printf("{\"%s\", {%.2f, %.2f}, {%.2f, %.2f}, %.4f},\n", now.scene, now.five_views.inside,
                now.five_views.border, now.one_view.inside, now.one_view.border, now.least_alpha);
    expect_no_worse(now.five_views, measured.five_views);
    expect_no_worse(now.one_view, measured.one_view);
    EXPECT_GE(now.least_alpha, measured.least_alpha - 1e-4); // rounding of float sums of weights: section 3
    if (now.scene == std::string_view("macro")) expect_relief(five, reference);
}

constexpr auto name_of = [](const auto &of) {
    std::string name = of.param.scene;
    std::erase(name, '-');
    return name;
};
INSTANTIATE_TEST_SUITE_P(All, Floors, testing::ValuesIn(measured_scenes), name_of);

class DoubledFloors : public testing::TestWithParam<MeasuredDoubled> {};

TEST_P(DoubledFloors, Hold) {
    const MeasuredDoubled &measured = GetParam();
    const SceneCamera scene(measured.scene, 240, 135);
    const SceneCamera large(measured.scene, 240 * twice, 135 * twice);
    const Decibels now = decibels(doubled(large), reference_of(measured.scene, scene));
    std::printf("{\"%s\", {%.2f, %.2f}},\n", measured.scene, now.inside, now.border);
    expect_no_worse(now, measured.five_views);
}

INSTANTIATE_TEST_SUITE_P(All, DoubledFloors, testing::ValuesIn(measured_doubled), name_of);

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
    const Decibels one = decibels(gather(ldi, scene), reference),
                   two = decibels(doubled(far_out_of_focus(twice)), reference);
    std::printf("cells {%.2f, %.2f}, doubled {%.2f, %.2f}\n", one.inside, one.border, two.inside, two.border);
    expect_no_worse(one, measured_cells);
    expect_no_worse(two, measured_doubled_cells);
}

TEST(DeepFloors, HoldForMist) {
    const SceneCamera scene("mist", 240, 135);
    Progress silent;
    const Ldi ldi = tidy(render_peeled(scene.tracer, scene.settings, 4, 16, 1, silent));
    const Decibels now = decibels(gather(ldi, scene), reference_of("mist", scene));
    std::printf("deep mist {%.2f, %.2f}\n", now.inside, now.border);
    expect_no_worse(now, measured_deep_mist);
}

} // namespace
} // namespace sparselens
