#include "base/error.h"
#include "io/plan_file.h"
#include "plan/plan.h"
#include "support/scratch_folder.h"
#include "support/views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.1, .focal_px = 100, .focus = 5};

View plane(float z) {
    return make_view(windows_of_size(48, 32), {0, 0},
                     [z](int, int) { return ViewPixel{.z = z, .r = 0.5f, .g = 0.5f, .b = 0.5f}; });
}

View card_before_wall() {
    return make_view(windows_of_size(80, 60), {0, 0}, [](int x, int y) {
        const bool card = x >= 30 && x < 50 && y >= 20 && y < 40;
        return ViewPixel{.z = card ? 2.0f : 10.0f, .r = card ? 1.0f : 0.2f};
    });
}

Plan plan_of(const View &centre, const PlanOptions &options = {}, const ThinLens &by = lens) {
    Progress silent;
    return make_plan(centre, by, options, silent);
}

TEST(Plan, OnePlaneAsksForNothing) {
    for (const float z : {0.5f, 3.0f, 5.0f, 100.0f, std::numeric_limits<float>::infinity()})
        EXPECT_TRUE(plan_of(plane(z)).views.empty()) << z;
}

TEST(Plan, ALensOfRadiusZeroAsksForNothing) {
    ThinLens pinhole = lens;
    pinhole.radius = 0;
    EXPECT_TRUE(plan_of(card_before_wall(), {}, pinhole).views.empty());
    EXPECT_TRUE(plan_of(card_before_wall(), {.views = 0}).views.empty());
}

// Each side view uncovers 4 px on its own side of the card; the views above and below look behind the other two edges.
TEST(Plan, ACardAsksForStripsAroundIt) {
    const Plan plan = plan_of(card_before_wall());
    ASSERT_EQ(plan.views.size(), 4u);
    for (const PlannedView &view : plan.views) EXPECT_EQ(view.uncovered, 4u * 20);
    EXPECT_FALSE(plan.full_views);
    EXPECT_LT(plan.share(), 0.6);
    EXPECT_GT(plan.share(), 4 * 8 * 24 / 4800.0);
}

// Three columns: the one that the wire hid, and one on either side. From the left it is the same column.
TEST(Plan, AWireAsksForTheColumnItHides) {
    const View wire = make_view(windows_of_size(80, 60), {0, 0}, [](int x, int) {
        return ViewPixel{.z = x == 40 ? 2.0f : 10.0f, .r = x == 40 ? 1.0f : 0.2f};
    });
    const Plan plan = plan_of(wire, {.views = 2});
    ASSERT_EQ(plan.views.size(), 1u);
    EXPECT_EQ(plan.views[0].uncovered, 60u);
    for (int x = 10; x < 70; ++x)
        EXPECT_EQ(plan.views[0].mask.at(Imath::V2i(x, 30)), std::abs(x - 39) <= 1) << x;
}

// Two columns on either side of a bar. Each bar has 8 columns itself and 64 beside it, or 100.
TEST(Plan, ManyEdgesAskForFineViews) {
    const auto bars = [](int apart, float z) {
        return make_view(windows_of_size(1200, 4), {0, 0}, [=](int x, int) {
            return ViewPixel{.z = x % apart < 8 ? z : 10.0f, .r = x % apart < 8 ? 1.0f : 0.2f};
        });
    };
    const Plan many = plan_of(bars(72, 2)), few = plan_of(bars(108, 2));
    EXPECT_NEAR(many.edges, 4.0 / 72, 2e-3);
    EXPECT_EQ(many.supersample, 2);
    EXPECT_NEAR(few.edges, 4.0 / 108, 2e-3);
    EXPECT_EQ(few.supersample, 1);
    EXPECT_EQ(plan_of(bars(72, 5.1f)).edges, 0); // disparities of 1.96 and 1
    EXPECT_EQ(plan_of(bars(72, 2), {.across = 2}).supersample, 1);
}

TEST(Plan, NoiseAsksForWholeViews) {
    const Plan clean = plan_of(card_before_wall(), {.noise = 1e-4}),
               noisy = plan_of(card_before_wall(), {.noise = 0.2});
    EXPECT_FALSE(clean.full_views);
    EXPECT_TRUE(noisy.full_views);
    EXPECT_EQ(noisy.share(), 4);
}

// Noise where the picture is in focus, none where it is blurred: the noisy pixels are asked for where each view shows
// them.
TEST(Plan, NoiseIsAskedForWhereItIs) {
    const ThinLens wide{.radius = 0.4, .focal_px = 100, .focus = 5}; // CoC -4 px at z = 3.33, disparity 12
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0.5, 0.02);
    const View view = make_view(windows_of_size(160, 60), {0, 0}, [&](int x, int) {
        const float value = float(noise(random));
        return ViewPixel{.z = x < 80 ? 5.0f : 10 / 3.0f, .r = value, .g = value, .b = value};
    });
    const Plan plan = plan_of(view, {.views = 2}, wide);
    EXPECT_FALSE(plan.full_views);
    ASSERT_EQ(plan.views.size(), 2u);
    for (const PlannedView &planned : plan.views) // their disparity is 8
        for (int x = 12; x < 60; ++x) EXPECT_TRUE(planned.mask.at(Imath::V2i(x, 30))) << x;
    EXPECT_NEAR(double(plan.noisy), 80 * 60, 8 * 60);
    EXPECT_FALSE(plan.views[0].mask.at(Imath::V2i(120, 30)));
    EXPECT_EQ(plan_of(view, {.views = 2, .noise = 0}, wide).noisy, 0u);
}

TEST(Plan, MarginsGrowAndViewsAreCounted) {
    EXPECT_LT(plan_of(card_before_wall(), {.margin = 0}).share(), plan_of(card_before_wall()).share());
    EXPECT_EQ(plan_of(card_before_wall(), {.views = 2}).views.size(), 2u);
    EXPECT_LE(plan_of(card_before_wall(), {.views = 8}).views.size(), 8u);
}

// c = R F / d (z - d) / z at the edge: 1 px at z = 10, 3 px at z = 2.
TEST(Plan, OverscanIsTheLargestCocAlongTheEdge) {
    View view = plane(10);
    view.z[10] = 2;
    const OverscanNeed overscan = plan_of(view).overscan;
    EXPECT_EQ(overscan.top, 3);
    EXPECT_EQ(overscan.left, 1);
    EXPECT_EQ(overscan.right, 1);
    EXPECT_EQ(overscan.bottom, 1);
}

// With pixels twice as wide as high, the same disc is twice as many pixels high.
TEST(Plan, OverscanAboveAndBelowCountsThePixelsAspect) {
    ThinLens stretched = lens;
    stretched.pixel_aspect = 2;
    View view = plane(10);
    view.z[10] = 2;
    const OverscanNeed overscan = plan_of(view, {}, stretched).overscan;
    EXPECT_EQ(overscan.top, 6);
    EXPECT_EQ(overscan.bottom, 2);
    EXPECT_EQ(overscan.left, 1);
}

TEST(PlanFile, MasksAndRectanglesComeBack) {
    const ScratchFolder folder;
    const View centre = card_before_wall();
    const Plan plan = plan_of(centre);
    const PlanSetting setting{"centre.exr", centre.image.windows, lens, 2, 3};
    for (const std::string &masks : {folder.file("masks"), std::string()}) {
        write_plan(folder.file("plan.json"), plan, setting, masks);
        const PlanRequest read = read_plan(folder.file("plan.json"));
        EXPECT_EQ(read.display, centre.image.windows.display);
        EXPECT_EQ(read.across, 3);
        ASSERT_EQ(read.views.size(), plan.views.size());
        for (std::size_t k = 0; k < plan.views.size(); ++k) {
            EXPECT_EQ(read.views[k].u, plan.views[k].u);
            const PixelMask &asked = plan.views[k].mask, back = mask_of(read.views[k]);
            std::size_t extra = 0;
            for (int y = asked.data.min.y; y <= asked.data.max.y; ++y)
                for (int x = asked.data.min.x; x <= asked.data.max.x; ++x) {
                    const bool there = back.data.intersects(Imath::V2i(x, y)) && back.at(Imath::V2i(x, y));
                    EXPECT_TRUE(there || !asked.at(Imath::V2i(x, y)));
                    extra += there && !asked.at(Imath::V2i(x, y));
                }
            EXPECT_TRUE(masks.empty() || extra == 0);
        }
    }
}

// A file of a few bytes may ask for more memory or work than is available.
TEST(PlanFile, ViewsAreRefusedThatNobodyCouldRender) {
    const ScratchFolder folder;
    const auto says = [&](const std::string &window, const std::string &rectangles) {
        put_contents(folder.file("plan.json"),
                     R"({"display_window": [0, 0, 9, 9], "views": [{"lens_point": [1, 0], "data_window": )" +
                         window + R"(, "rectangles": [)" + rectangles + "]}]}");
        return what_of<Error>([&] { read_plan(folder.file("plan.json")); });
    };
    const auto refused = [&](const std::string &window, const std::string &rectangles, const char *why) {
        const std::string message = says(window, rectangles);
        EXPECT_NE(message.find("plan.json: "), std::string::npos) << message;
        EXPECT_NE(message.find(why), std::string::npos) << message;
    };
    EXPECT_EQ(says("[0, 0, 9, 9]", "[0, 0, 9, 9], [3, 3, 4, 4]"), "(nothing was thrown)");
    refused("[0, 0, 1e300, 1]", "", "a corner of a window is 1e+300, not a pixel");
    refused("[0, 0, 0.5, 1]", "", "not a pixel");
    refused("[0, 0, 2147483648, 1]", "", "not a pixel");
    refused("[-2147483647, 0, 2147483647, 0]", "", "too large");
    refused("[0, 0, 16384, 16383]", "", "too large");
    refused("[0, 0, 9, 9]", "[0, 0, 10, 9]", "not in the data_window");
    std::string often = "[0, 0, 9, 9]";
    for (int i = 1; i <= 64; ++i) often += ", [0, 0, 9, 9]";
    refused("[0, 0, 9, 9]", often, "overlap too often");
}

// 1000 views of 16384 x 16384 pixels would be 268 GB as masks.
TEST(PlanFile, ViewsTakeNoMemoryBeforeTheyAreRendered) {
    const ScratchFolder folder;
    std::string text = R"({"display_window": [0, 0, 9, 9], "views": [)";
    for (int i = 0; i < 1000; ++i)
        text += std::string(i > 0 ? "," : "") +
                R"({"lens_point": [1, 0], "data_window": [0, 0, 16383, 16383], "rectangles": []})";
    put_contents(folder.file("plan.json"), text + "]}");
    const PlanRequest plan = read_plan(folder.file("plan.json"));
    EXPECT_EQ(plan.views.size(), 1000u);
    EXPECT_TRUE(plan.views[999].rectangles.empty());
}

TEST(PlanFile, WhatIsNoPlanIsRefused) {
    const ScratchFolder folder;
    for (const char *text : {"", "{", "[]", "{\"display_window\": [0, 0, 9, 9]}",
                             "{\"display_window\": [9, 9, 0, 0], \"views\": []}",
                             "{\"display_window\": [0, 0, 9, 9], \"views\": [{\"name\": 3}]}"}) {
        put_contents(folder.file("plan.json"), text);
        EXPECT_NE(what_of<Error>([&] { read_plan(folder.file("plan.json")); }).find("plan.json"),
                  std::string::npos)
            << text;
    }
}

} // namespace
} // namespace sparselens
