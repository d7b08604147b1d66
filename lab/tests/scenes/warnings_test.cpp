// Warnings: none about correct views, for all scenes at usual sizes and numbers of samples; and each mistake is named
// if pixels show it.
#include "deep/checks/view_warnings.h"
#include "io/open_view.h"
#include "lab/tests/support/traced.h"
#include "lab/trace/scenes.h"
#include "support/shared_files.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace sparselens {
namespace {

using namespace lab;

// A picture of 160x90 pixels, each of which is `across` x `across` sub-pixels and has `samples` samples.
struct Sampling {
    int across, samples;
    bool has_its_places_tested = false;
};
constexpr Sampling samplings[] = {{1, 1, true}, {1, 4},  {1, 16, true}, {1, 64}, {2, 4, true},
                                  {2, 16},      {2, 64}, {4, 16},       {4, 64}};

struct Shot {
    Shot(std::string_view name, const Sampling &by, Light light = Light::sun)
        : traced(name, 160 * by.across, 90 * by.across), samples(by.samples / (by.across * by.across)),
          label(std::string(name) + ", " + std::to_string(by.across) + "x, " + std::to_string(by.samples) +
                " samples: ") {
        traced.settings.light = light;
        facts.camera = traced.tracer.scene().camera;
    }
    View view(double x, double y, std::uint32_t stream) const { return traced.view({x, y}, samples, stream); }
    std::vector<View> views() const { return {view(0, 0, 0), view(1, 0, 1)}; }
    double radius() const { return traced.settings.lens.radius; }

    SceneCamera traced;
    int samples;
    std::string label;
    ViewFacts facts;
};

std::string said_of(const std::vector<View> &views, const ViewFacts &facts) {
    std::string all;
    for (const std::string &warning : view_warnings(views, facts)) all += warning + "\n";
    return all;
}

// Colours encoded for a display.
View encoded(View view) {
    for (std::size_t k = 0; k < 3; ++k)
        for (float &v : view.image.plane(k))
            v = v <= 0.0031308f ? v * 12.92f : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
    return view;
}

// In grey scenes, and with one sample per pixel, no colour shows it.
void expect_encoded_colours_are_named(const Shot &shot, const View &view, const std::string &name,
                                      const Sampling &by) {
    const std::vector<std::string> coloured{
        "fence",   "grass", "mirror",           "plane-mirror", "curved-mirrors", "glossy-floor",
        "element", "plate", "element-in-plate", "macro",        "scales"};
    if (std::ranges::find(coloured, name) == coloured.end() || by.samples == by.across * by.across) return;
    const std::string said = said_of({encoded(view)}, shot.facts);
    EXPECT_NE(said.find("mix at edges as sRGB codes do"), std::string::npos) << shot.label << said;
}

void expect_wrong_places_are_named(const Shot &shot, std::vector<View> views, const std::string &name) {
    if (name == "lamps") return; // a dark wall
    const double r = shot.radius();
    std::vector<Imath::V2d> wrong{{-r, 0}, {0, r}};
    // Distances need depth edges: these scenes have none, or their edges are parallel to the view's
    // displacement.
    if (name != "planes" && name != "slant") wrong.insert(wrong.end(), {{r / 2, 0}, {2 * r, 0}});
    if (name == "plate") wrong = {{-r, 0}, {2 * r, 0}}; // the scene shows little motion
    for (const Imath::V2d &place : wrong) {
        views[1].position = place;
        const std::string said = said_of(views, shot.facts);
        EXPECT_NE(said.find("disagrees with the centre view"), std::string::npos)
            << shot.label << place << "\n"
            << said;
    }
}

// One test for all, because tracing the views takes longer than the checks.
TEST(Warnings, ThereAreNoneOfGoodViewsAndMistakesAreNamed) {
    std::size_t sets = 0;
    for (const SceneEntry &scene : scene_table())
        for (const Sampling &by : samplings) {
            const std::string name(scene.name);
            const Shot shot(name, by);
            const std::vector<View> views = shot.views();
            EXPECT_EQ(said_of(views, shot.facts), "") << shot.label;
            expect_encoded_colours_are_named(shot, views[0], name, by);
            if (by.has_its_places_tested) expect_wrong_places_are_named(shot, views, name);
            ++sets;
        }
    EXPECT_GE(sets, 60u);
}

TEST(Warnings, DepthOfFieldIsNamed) {
    for (const std::string name :
         {"fence", "grass", "mirror", "plane-mirror", "glossy-floor", "element-in-plate", "slant"}) {
        const Shot shot(name, {4, 16});
        View view = shot.view(0, 0, 0);
        const Image reference = shot.traced.reference(16);
        for (std::size_t k = 0; k < 3; ++k)
            std::ranges::copy(reference.plane(find_channel(reference.channels, view.image.channels[k].name)),
                              view.image.plane(k).begin());
        const std::string said = said_of({view}, shot.facts);
        EXPECT_NE(said.find("switch depth of field off"), std::string::npos) << shot.label << said;
    }
}

TEST(Warnings, PlacesInMillimetresAreAskedFor) {
    const Shot shot("fence", {1, 4});
    for (const double factor : {10.0, 100.0, 1000.0}) {
        std::vector<View> views{shot.view(0, 0, 0), shot.view(1, 0, 1), shot.view(0, 1, 2)};
        for (View &view : views) view.position *= factor;
        const std::vector<std::string> said = view_warnings(views, shot.facts);
        ASSERT_EQ(said.size(), 1u) << factor;
        EXPECT_NE(said[0].find("in millimetres?"), std::string::npos) << said[0];
    }
}

// Path-traced views beside the sources, which exist on some machines; camera.json has their positions.
std::vector<View> path_traced(const std::filesystem::path &folder, const nlohmann::json &camera,
                              ViewFacts &facts) {
    const double radius = camera["lens_radius"];
    const OpenOptions options{.lens = {.focal_length_mm = camera["focal_mm"].get<double>(),
                                       .sensor_width_mm = 36.0,
                                       .lens_radius = radius,
                                       .focus_distance = camera["focus_distance"].get<double>()}};
    OpenedView centre = open_view((folder / "center.exr").string(), options);
    facts = {centre.depth, centre.depth_filtered, centre.camera};
    std::vector<View> views{std::move(centre.view)};
    std::vector<std::size_t> taken;
    for (std::size_t k = 0; k < 8; ++k)
        if (std::filesystem::exists(folder / ("view_" + std::to_string(k) + ".exr"))) taken.push_back(k);
    for (std::size_t i = 0; i < taken.size(); ++i) {
        views.push_back(
            open_view((folder / ("view_" + std::to_string(taken[i]) + ".exr")).string(), options).view);
        const auto &place = camera["views"][camera["views"].size() == taken.size() ? i : taken[i]];
        views.back().position = radius * Imath::V2d(place[0].get<double>(), place[1].get<double>());
    }
    return views;
}

class PathTracedViews : public ::testing::TestWithParam<const char *> {};

TEST_P(PathTracedViews, AreGood) {
    const std::string folder = shared_file(std::string("views/") + GetParam());
    if (folder.empty()) GTEST_SKIP() << "../shared/views/" << GetParam() << " is not there";
    nlohmann::json camera;
    std::ifstream(std::filesystem::path(folder) / "camera.json") >> camera;
    ViewFacts facts;
    const std::vector<View> views = path_traced(folder, camera, facts);
    EXPECT_EQ(said_of(views, facts), "");
    // Views stay valid with another lens or another focus.
    const Camera own = facts.camera;
    for (const double radius : {0.25, 0.5, 1.0, 2.0})
        for (const double focus : {0.5, 0.8, 1.25, 2.0, 8.0}) {
            facts.camera.lens_radius = radius * *own.lens_radius;
            facts.camera.focus_distance = focus * *own.focus_distance;
            EXPECT_EQ(said_of({views[0]}, facts), "") << radius << " " << focus;
        }
}

INSTANTIATE_TEST_SUITE_P(, PathTracedViews,
                         ::testing::Values("macro", "pelt", "pelt_2x", "pinecone", "porch", "street", "yard",
                                           "yard/4spp", "yard_2x"),
                         [](const auto &param) {
                             std::string name = param.param;
                             std::ranges::replace(name, '/', '_');
                             return name;
                         });

} // namespace
} // namespace sparselens
