// Makes LDIs from views and from other LDIs in memory, with a known number of samples.
#include "base/error.h"
#include "chain/make_ldi.h"
#include "chain/notices.h"
#include "chain/plan_views.h"
#include "chain/regions.h"
#include "io/camera/camera_header.h"
#include "support/ldi_samples.h"
#include "support/scratch_folder.h"
#include "support/views.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

const Windows windows = windows_of_size(40, 30);
const LensValues lens{
    .focal_length_mm = 640, .sensor_width_mm = 40, .lens_radius = 0.06, .focus_distance = 5};

struct Told {
    std::vector<std::string> words;
    Notify notify() {
        return [this](const Notice &notice) { words.push_back(words_of(notice)); };
    }
    bool has(const std::string &text) const { return std::ranges::find(words, text) != words.end(); }
};

// A wall of which only the first `columns` columns were rendered.
OpenedView wall(int columns) {
    OpenedView in;
    in.view = make_view(windows, {0, 0}, [&](int x, int) {
        return x < columns ? ViewPixel{5, 0.5f, 0.5f, 0.5f, 1} : ViewPixel{5, 0, 0, 0, 0};
    });
    in.view.name = "view.exr";
    in.header = Imf::Header(windows.display, windows.data);
    return in;
}

TEST(MakeLdi, CountsWhatViewsGive) {
    const OpenedView centre = wall(20), none = wall(0);
    const ViewInMemory views[] = {{.flat = &centre}, {.flat = &none, .position = Imath::V2d(0.06, 0)}};
    LdiFromViews request{.name = "made", .supersample = 2, .lens = lens};
    Told told;
    Progress silent;
    const MadeLdi made = make_ldi(views, request, {silent, told.notify()});
    EXPECT_EQ(made.views, 2u);
    EXPECT_EQ(made.empty_views, 1u);
    EXPECT_EQ(made.pixels_given, 20u * 30);
    EXPECT_EQ(made.all_pixels, 2u * 40 * 30);
    EXPECT_EQ(made.ldi.samples(), 20u * 30);
    EXPECT_TRUE(told.has("2 views, 600 samples in 1200 pixels"));
    EXPECT_EQ(made.camera.lens_points.size(), 2u);
    const Camera written = read_camera(made.header);
    EXPECT_EQ(written.supersample, 2);
    EXPECT_EQ(written.focal_length_mm, 640);
    EXPECT_EQ(centre.view.image.at(0, 0, 0), 0.5f); // is not consumed
}

TEST(MakeLdi, NeedsADepthFileForEachPicture) {
    EXPECT_EQ(depths_of_pictures({}, {"a", "b"}, 2)[1].picture.depth_file, "b");
    EXPECT_EQ(depths_of_pictures({}, {}, 3).size(), 3u);
    EXPECT_EQ(
        what_of<UsageError>([] { depths_of_pictures({}, {"a"}, 2); }),
        "`depth_file`: there are 1 of them for 2 pictures; give one for each, in the order of the pictures");
}

OpenedLdi glass(double z, double focal_length) {
    OpenedLdi in;
    in.name = "glass.exr";
    in.ldi = make_ldi(windows, rgba_channels(), [&](int, int) {
        return std::vector<Sample>{{z, {0.2f, 0.2f, 0.2f, 0.5f}}};
    });
    in.header = Imf::Header(windows.display, windows.data);
    in.camera = camera_with_options(lens, {});
    in.camera.focal_length_mm = focal_length;
    return in;
}

// R F (1/2 - 1/4) is 9.6 pixels.
TEST(ClusterLdi, MergesByTheLensOrWithoutIt) {
    const OpenedLdi front = glass(2, 640), back = glass(4, 640);
    const OpenedLdi *both[] = {&back, &front};
    const auto samples = [&](const ClusterRequest &request, Told &told) {
        Progress silent;
        return cluster_ldi(both, request, silent, told.notify()).ldi.samples();
    };
    Told told, blind;
    EXPECT_EQ(samples({.lens = lens, .tolerance = 9.5}, told), 2400u);
    EXPECT_EQ(samples({.lens = lens, .tolerance = 9.7}, told), 1200u);
    EXPECT_TRUE(told.has("2400 samples to 2400, CoC changed by at most 0.000000 px"));
    OpenedLdi unknown_front = front, unknown_back = back;
    unknown_front.camera = unknown_back.camera = {};
    both[0] = &unknown_back;
    both[1] = &unknown_front;
    EXPECT_EQ(samples({.layers = 1}, blind), 1200u);
    EXPECT_TRUE(blind.has("2400 samples to 1200, by inverse depth alone, because the lens is unknown"));
    EXPECT_THROW(samples({}, blind), UsageError);
}

// LDIs with different focal lengths can be merged if the lens is given, as the message says.
TEST(ClusterLdi, TakesTheLensThatIsGivenForThatOfAll) {
    const OpenedLdi front = glass(2, 640), back = glass(4, 320);
    const OpenedLdi *both[] = {&front, &back};
    Progress silent;
    Told told;
    EXPECT_THROW(cluster_ldi(both, {.tolerance = 0}, silent, told.notify()), Error);
    const ClusteredLdi made = cluster_ldi(both, {.lens = lens, .tolerance = 0}, silent, told.notify());
    EXPECT_EQ(made.ldi.samples(), 2400u);
    EXPECT_EQ(made.camera.focal_length_mm, 640);
    EXPECT_EQ(read_camera(made.header).focal_length_mm, 640);
}

TEST(PlanViews, IsForPixelsOfThePicture) {
    OpenedView centre = wall(40);
    centre.camera.supersample = 2;
    Progress silent;
    Told told;
    EXPECT_EQ(plan_views(centre, {.views = 0}, lens, {}, {}, silent, told.notify()).setting.across, 2);
    const PlannedViews planned = plan_views(centre, {.views = 0}, lens, 4, 20, silent, told.notify());
    EXPECT_EQ(planned.setting.division->views, 1); // none is planned
    EXPECT_EQ(planned.setting.division->per_render, 6);
    EXPECT_EQ(planned.setting.across, 4);
    EXPECT_EQ(planned.camera.supersample, 4);
    EXPECT_EQ(planned.setting.lens.radius, 0.06);
    EXPECT_EQ(planned.setting.centre, "view.exr");
}

TEST(RegionsOver, AreOfPixelsOrOfTheirSubpixels) {
    OpenedLdi in = glass(5, 640); // in focus
    Told told;
    EXPECT_EQ(regions_over(windows, in, lens, told.notify()).size(), 1200u);
    EXPECT_TRUE(
        told.has("the regions are those of a lens of radius 0.06, focal length 640 pixels, focused at 5"));
    EXPECT_THROW(regions_over(windows_of_size(20, 15), in, lens, told.notify()), Error);
    in.camera.supersample = 2;
    EXPECT_EQ(regions_over(windows_of_size(20, 15), in, lens, told.notify()).size(), 300u);
}

TEST(Words, SayTheParameterAndWhetherItMatters) {
    const Notice unsure{NoticeKind::camera_unsure, "a.exr", {"two values"}, "focal_length"};
    EXPECT_EQ(words_of(unsure), "a.exr: two values; `focal_length` settles it");
    EXPECT_EQ(level_of(unsure), NoticeLevel::note);
    const Notice clamped{NoticeKind::clamped, "a.exr", {std::size_t(3)}};
    EXPECT_EQ(words_of(clamped), "a.exr: 3 values beyond the range of half are clamped to 65504");
    EXPECT_EQ(level_of(clamped), NoticeLevel::warning);
    EXPECT_EQ(words_of({.kind = NoticeKind::uploaded, .values = {1.26}}), "uploaded to the device: 1.3 MB");
    EXPECT_EQ(words_of({.kind = NoticeKind::file_warning, .file = "{x}", .values = {"{y}"}}), "{x}: {y}");
}

} // namespace
} // namespace sparselens
