#include "base/error.h"
#include "lab/reporting/process.h"
#include "lab/reporting/systems.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

namespace sparselens::lab {
namespace {

namespace fs = std::filesystem;

struct Planned {
    ScenePlan plan;
    std::vector<Step> steps;

    const PlannedRow &row(const std::string &method, const std::string &budget) const {
        const auto found = std::ranges::find_if(plan.rows, [&](const PlannedRow &r) {
            return method_name(r.row) == method && r.row.budget == budget;
        });
        if (found == plan.rows.end()) throw std::runtime_error("no row " + method + " at " + budget);
        return *found;
    }
    bool has(const std::string &renderer) const {
        return std::ranges::any_of(plan.rows,
                                   [&](const PlannedRow &r) { return r.row.renderer == renderer; });
    }
    // The commands whose time counts for the row.
    std::string commands(const PlannedRow &row) const {
        std::string text;
        for (const std::size_t step : row.steps)
            for (const StepCommand &command : steps[step].commands)
                text += command_line(command.words) + '\n';
        return text;
    }
};

Planned planned(const std::string &scene, Detail detail = Detail::all, bool can_plan = false) {
    StepList steps;
    ScenePlan plan = plan_scene(*open_scene(scene, Budgets{}, can_plan), Budgets{}, detail, steps);
    return {std::move(plan), steps.steps()};
}

TEST(Systems, TheWholeTaxonomyIsThere) {
    const Planned all = planned("fence"), quick = planned("fence", Detail::one_of_each);
    std::set<std::string> methods, quick_methods;
    for (const PlannedRow &row : all.plan.rows) methods.insert(method_name(row.row));
    for (const PlannedRow &row : quick.plan.rows) quick_methods.insert(method_name(row.row));
    const std::set<std::string> expected{"one view, scatter",
                                         "one view, gather",
                                         "one view, lens normal",
                                         "4 strata, layered blend",
                                         "4 strata, lens normal",
                                         "4 peeled layers, layered blend",
                                         "4 peeled layers, lens normal",
                                         "accumulated lens views",
                                         "distributed ray tracing",
                                         "centre + 4, selective K=2",
                                         "centre + 4, selective K=4",
                                         "centre + 4, selective K=8",
                                         "centre + 4, lens draft",
                                         "centre + 4, lens normal",
                                         "centre + 4, lens final",
                                         "centre + 4 at 2x, lens normal",
                                         "centre + 4 at 2x, lens final",
                                         "centre + 8, selective K=2",
                                         "centre + 8, selective K=4",
                                         "centre + 8, selective K=8",
                                         "centre + 8, lens draft",
                                         "centre + 8, lens normal",
                                         "centre + 8, lens final"};
    EXPECT_EQ(methods, expected);
    EXPECT_EQ(all.plan.rows.size(),
              4u * 7 + 5 + 5 + 4 * 12 +
                  3 * 2); // four sample counts, five of rays and lens views; three of fine views
    EXPECT_TRUE(std::ranges::includes(methods, quick_methods));
    EXPECT_EQ(quick_methods.size(), 14u);
}

TEST(Systems, StepsComeAfterWhatTheyRead) {
    const Planned all = planned("fence", Detail::all, true);
    std::set<std::string> names, made;
    for (std::size_t i = 0; i < all.steps.size(); ++i) {
        EXPECT_TRUE(names.insert(all.steps[i].name).second) << all.steps[i].name;
        for (const std::size_t input : all.steps[i].inputs) EXPECT_LT(input, i);
        for (const std::string &output : all.steps[i].outputs)
            EXPECT_TRUE(made.insert(output).second) << output;
    }
    for (const PlannedRow &row : all.plan.rows) {
        EXPECT_TRUE(made.contains(row.picture)) << row.picture;
        EXPECT_TRUE(row.many_points.empty() || made.contains(row.many_points)) << row.many_points;
    }
    EXPECT_TRUE(made.contains(all.plan.centre.picture));
}

TEST(Systems, ARowTakesTheTimeOfItsWholeChain) {
    const Planned all = planned("fence");
    EXPECT_EQ(all.commands(all.row("centre + 4, lens final", "16 samples")),
              "dof-trace fence --size 640x360 --spp 16 --views 4 -o fence/views-5x16\n"
              "ldi-warp fence/views-5x16/center.exr fence/views-5x16/view_0.exr fence/views-5x16/view_1.exr "
              "fence/views-5x16/view_2.exr fence/views-5x16/view_3.exr -o fence/views-5x16/warped.exr\n"
              "dof-gather fence/views-5x16/warped.exr --method lens --quality final -o "
              "fence/views-5x16/lens-final.exr\n");
    EXPECT_EQ(all.commands(all.row("centre + 8, selective K=2", "1 sample")).substr(0, 73),
              "dof-trace fence --size 640x360 --spp 1 --views 8 -o fence/views-9x1\nldi-w");
    // The same number of rays, in pixels of a quarter of the area.
    EXPECT_EQ(all.commands(all.row("centre + 4 at 2x, lens final", "16 samples")),
              "dof-trace fence --size 640x360 --spp 16 --views 4 -o fence/fine-5x16 --supersample 2\n"
              "ldi-warp fence/fine-5x16/center.exr fence/fine-5x16/view_0.exr fence/fine-5x16/view_1.exr "
              "fence/fine-5x16/view_2.exr fence/fine-5x16/view_3.exr -o fence/fine-5x16/warped.exr\n"
              "dof-gather fence/fine-5x16/warped.exr --method lens --quality final --supersample 2 -o "
              "fence/fine-5x16/lens-final.exr\n");
    EXPECT_EQ(all.row("centre + 4 at 2x, lens final", "16 samples").row.rays, 80);
    EXPECT_EQ(all.commands(all.row("4 peeled layers, layered blend", "4 samples")),
              "dof-trace fence --size 640x360 --spp 4 --views 0 -o fence/peel-4x4 --deep peel:4\n"
              "dof-gather fence/peel-4x4/deep_peel.exr --method selective --layers 8 -o "
              "fence/peel-4x4/selective-8.exr\n");
    EXPECT_EQ(all.commands(all.row("distributed ray tracing", "64 rays")),
              "dof-trace fence --size 640x360 --spp 1 --views 0 -o fence/traced-64 --reference 64\n");
    // The picture for the comparison counts in no row's time.
    for (const PlannedRow &row : all.plan.rows)
        for (const std::size_t step : row.steps) EXPECT_TRUE(all.steps[step].timed);
}

// Only for the lens gather over centre and 4 with most samples, because a pull costs as much as 16 pictures.
TEST(Systems, PullsOfFocusShowHowSteadyTheLensIs) {
    const Planned all = planned("fence");
    const PlannedRow &row = all.row("centre + 4, lens final", "64 samples");
    ASSERT_EQ(row.pull.size(), 16u);
    EXPECT_EQ(row.pull.back(), "fence/views-5x64/pull-final.0016.exr");
    const auto step = std::ranges::find_if(
        all.steps, [&](const Step &s) { return s.name == "fence/views-5x64/pull-final"; });
    ASSERT_NE(step, all.steps.end());
    EXPECT_EQ(
        command_line(step->commands[0].words),
        "dof-gather fence/views-5x64/warped.exr --quality final -o fence/views-5x64/pull-final.####.exr "
        "--focus-distance 1:5,16:5.5 --frames 1-16");
    EXPECT_FALSE(step->timed);
    EXPECT_EQ(std::ranges::count_if(all.plan.rows, [](const PlannedRow &r) { return !r.pull.empty(); }), 3);
}

TEST(Systems, RaysAreCameraSamplesOfAllViews) {
    const Planned all = planned("fence");
    EXPECT_EQ(all.row("one view, gather", "16 samples").row.rays, 16);
    EXPECT_EQ(all.row("centre + 4, lens normal", "16 samples").row.rays, 80);
    EXPECT_EQ(all.row("centre + 8, lens normal", "1 sample").row.rays, 9);
    EXPECT_EQ(all.row("4 strata, lens normal", "16 samples").row.rays, 64);
    EXPECT_EQ(all.row("accumulated lens views", "256 views").row.rays, 4 * 256);
    EXPECT_EQ(all.row("distributed ray tracing", "1024 rays").row.rays, 1024);
    EXPECT_EQ(all.row("centre + 4, lens normal", "16 samples").row.role, Role::sparse_lens);
    EXPECT_EQ(all.row("centre + 4, selective K=8", "16 samples").row.role, Role::other);
    EXPECT_EQ(all.row("4 strata, lens normal", "16 samples").row.role, Role::other);
    EXPECT_EQ(all.row("distributed ray tracing", "4 rays").row.role, Role::ray_tracing);
}

TEST(Systems, NoiseOfTheReferenceIsItsOwn) {
    const Planned all = planned("fence");
    const Step &reference = all.steps[all.plan.reference.steps.front()];
    EXPECT_NE(command_line(reference.commands[0].words).find("--reference 4096 --seed 1"), std::string::npos);
    EXPECT_FALSE(reference.timed);
}

TEST(Systems, PlannedViewsAreThereWhereThereIsAPlanner) {
    EXPECT_FALSE(planned("fence").has("centre + 4 planned"));
    const Planned with = planned("fence", Detail::all, true);
    const PlannedRow &row = with.row("centre + 4 planned, lens normal", "16 samples");
    EXPECT_EQ(row.row.role, Role::sparse_lens);
    EXPECT_EQ(row.row.rays, 16); // the partial views' rays are counted after rendering
    EXPECT_EQ(row.partial_samples, 16);
    const std::string commands = with.commands(row);
    EXPECT_NE(
        commands.find("ldi-plan fence/views-1x16/center.exr --views 4 -o fence/planned-5x16/plan.json\n"),
        std::string::npos);
    EXPECT_NE(commands.find("--plan fence/planned-5x16/plan.json"), std::string::npos);
    EXPECT_NE(commands.find("ldi-warp fence/views-1x16/center.exr fence/planned-5x16/views/view_*.exr"),
              std::string::npos);
}

// A folder of 8 views with 64 samples per pixel, and inside it another folder of 2 views with 4 samples.
class ReadyViews : public testing::Test {
protected:
    ReadyViews() {
        fs::create_directories(folder_ / "few");
        put_contents(folder_ / "reference.exr", "");
        put_contents(folder_ / "drt_16.exr", "");
        std::string points, seconds = "\"center.exr\": 20, \"drt_16.exr\": 2.5, \"drt_4.exr\": 0.5";
        for (int k = 0; k < 8; ++k) {
            points += (k ? ", [" : "[") + std::to_string(k) + ", 1]";
            seconds += ", \"view_" + std::to_string(k) + ".exr\": " + std::to_string(k);
        }
        put_contents(folder_ / "camera.json", camera(points, 64, seconds));
        put_contents(folder_ / "few" / "camera.json",
                     camera("[1, 0], [-1, 0]", 4, "\"center.exr\": 1, \"view_0.exr\": 2, \"view_1.exr\": 3"));
    }

    static std::string camera(const std::string &points, int samples, const std::string &seconds) {
        return "{\"width\": 64, \"height\": 36, \"focal_mm\": 50.0, \"sensor_width_mm\": 36, \"fstop\": 0.5, "
               "\"focus_distance\": 6, \"lens_radius\": 0.5, \"views\": [" +
               points + "], \"view_spp\": " + std::to_string(samples) +
               ", \"ref_spp\": 1024, \"seconds\": {" + seconds + "}}";
    }

    ScratchFolder scratch_;
    fs::path folder_ = scratch_.file("a yard");
};

TEST_F(ReadyViews, RowsAreWhatTheViewsAllow) {
    const Planned all = planned(folder_.string());
    EXPECT_EQ(all.plan.name, "a-yard");
    EXPECT_TRUE(all.has("one view"));
    EXPECT_TRUE(all.has("centre + 4"));
    EXPECT_TRUE(all.has("centre + 8"));
    for (const char *renderer :
         {"4 strata", "4 peeled layers", "accumulated lens views", "centre + 4 planned"})
        EXPECT_FALSE(all.has(renderer)) << renderer;
    const auto count = [&](const std::string &renderer) {
        return std::ranges::count_if(all.plan.rows,
                                     [&](const auto &r) { return r.row.renderer == renderer; });
    };
    EXPECT_EQ(count("one view"), 6);                // both sample counts
    EXPECT_EQ(count("centre + 4"), 6);              // only with 64 samples
    EXPECT_EQ(count("distributed ray tracing"), 1); // the other has a time but no picture
    for (const Step &step : all.steps) EXPECT_NE(step.commands[0].words[0], "dof-trace");
}

TEST_F(ReadyViews, FourOfEightViewsAreEverySecond) {
    const Planned all = planned(folder_.string());
    const PlannedRow &row = all.row("centre + 4, lens normal", "64 samples");
    EXPECT_EQ(row.row.seconds[0], 20 + 0 + 2 + 4 + 6);
    EXPECT_EQ(row.row.rays, 320);
    EXPECT_EQ(all.row("centre + 8, lens normal", "64 samples").row.seconds[0], 20 + 28);
    EXPECT_EQ(all.row("one view, gather", "4 samples").row.seconds[0], 1);
    EXPECT_EQ(all.row("distributed ray tracing", "16 rays").row.seconds[0], 2.5);
    const std::string folder = folder_.string();
    EXPECT_EQ(all.commands(row).substr(0, all.commands(row).find('\n')),
              "ldi-warp " + folder + "/center.exr --view 0,0.5 " + folder + "/view_0.exr --view 1,0.5 " +
                  folder + "/view_2.exr --view 2,0.5 " + folder + "/view_4.exr --view 3,0.5 " + folder +
                  "/view_6.exr --focal-length 50 --sensor-width 36 --lens-radius 0.5 --focus-distance 6 "
                  "-o a-yard/views-5x64/warped.exr");
}

TEST_F(ReadyViews, FinerViewsAreGatheredIntoTheSizeOfThePicture) {
    EXPECT_FALSE(planned(folder_.string()).has("centre + 4 at 2x"));
    fs::create_directories(folder_ / "fine");
    std::string json = camera("[1, 0], [0, 1], [-1, 0], [0, -1]", 16,
                              "\"center.exr\": 9, \"view_0.exr\": 1, \"view_1.exr\": 1, \"view_2.exr\": 1, "
                              "\"view_3.exr\": 1");
    json.insert(1, "\"supersample\": 2, ");
    put_contents(folder_ / "fine" / "camera.json", json);
    const Planned all = planned(folder_.string());
    const PlannedRow &row = all.row("centre + 4 at 2x, lens normal", "16 samples");
    EXPECT_EQ(row.row.rays, 80);
    EXPECT_EQ(row.row.seconds[0], 13);
    EXPECT_EQ(row.row.role, Role::sparse_lens);
    EXPECT_NE(all.commands(row).find("/fine-5x16/warped.exr --method lens --quality normal --supersample 2 "),
              std::string::npos);
    EXPECT_EQ(all.commands(row).find("--supersample"), all.commands(row).rfind("--supersample"));
    EXPECT_EQ(all.commands(all.row("centre + 4, lens normal", "64 samples")).find("--supersample"),
              std::string::npos);
}

TEST_F(ReadyViews, PicturesOfOtherWaysAreRowsWithTheirPulls) {
    const auto write = [&](const std::string &seconds) {
        std::string json = camera("[1, 0]", 64, seconds);
        json.insert(1, "\"others\": [{\"file\": \"by_them.exr\", \"renderer\": \"one view\", "
                       "\"processor\": \"theirs\", \"budget\": \"64 samples\", \"rays\": 64}], ");
        put_contents(folder_ / "camera.json", json);
    };
    write("\"center.exr\": 20, \"view_0.exr\": 1, \"drt_16.exr\": 2.5, \"by_them.exr\": 21");
    for (const char *frame : {"drt_16.pull.0001.exr", "drt_16.pull.0002.exr", "by_them.pull.0001.exr"})
        put_contents(folder_ / frame, "");
    const Planned all = planned(folder_.string());
    const PlannedRow &row = all.row("one view, theirs", "64 samples");
    EXPECT_EQ(row.row.seconds[0], 21);
    EXPECT_EQ(row.row.rays, 64);
    EXPECT_EQ(row.row.role, Role::other);
    EXPECT_EQ(row.picture, (folder_ / "by_them.exr").string());
    EXPECT_EQ(row.pull, std::vector<std::string>{(folder_ / "by_them.pull.0001.exr").string()});
    EXPECT_EQ(all.row("distributed ray tracing", "16 rays").pull.size(), 2u);
    EXPECT_TRUE(all.row("one view, gather", "64 samples").pull.empty());
    write("\"center.exr\": 20, \"view_0.exr\": 1");
    EXPECT_THROW(planned(folder_.string()), Error);
}

TEST_F(ReadyViews, WhatADenoiserMadeHasItsOwnRows) {
    const Planned without = planned(folder_.string());
    EXPECT_FALSE(without.has("denoised ray tracing"));
    EXPECT_FALSE(without.has("centre + 4 denoised"));
    std::string points, seconds = "\"center.exr\": 20, \"drt_16.exr\": 2.5";
    for (const std::string name : {"center", "view_0", "view_1", "view_2", "view_3", "drt_16"}) {
        put_contents(folder_ / (name + ".denoised.exr"), "");
        seconds += ", \"" + name + ".denoised.exr\": 30";
    }
    for (int k = 0; k < 4; ++k) {
        points += (k ? ", [" : "[") + std::to_string(k) + ", 1]";
        seconds += ", \"view_" + std::to_string(k) + ".exr\": " + std::to_string(k);
    }
    put_contents(folder_ / "camera.json", camera(points, 64, seconds));
    const Planned all = planned(folder_.string());
    const PlannedRow &views = all.row("centre + 4 denoised, lens normal", "64 samples");
    EXPECT_EQ(views.row.seconds[0], 5 * 30);
    EXPECT_EQ(views.row.rays, 320);
    EXPECT_EQ(views.row.role, Role::other);
    EXPECT_NE(all.commands(views).find("view_3.denoised.exr"), std::string::npos);
    EXPECT_NE(all.commands(views).find("-o a-yard/views-denoised-5x64/warped.exr"), std::string::npos);
    EXPECT_EQ(all.row("centre + 4, lens normal", "64 samples").row.seconds[0], 20 + 0 + 1 + 2 + 3);
    const PlannedRow &traced = all.row("denoised ray tracing", "16 rays");
    EXPECT_EQ(traced.row.seconds[0], 30);
    EXPECT_EQ(traced.row.role, Role::other);
    EXPECT_EQ(traced.picture, (folder_ / "drt_16.denoised.exr").string());
}

TEST_F(ReadyViews, WhatIsMissingIsNamed) {
    const auto error = [&] { return what_of<Error>([&] { planned(folder_.string()); }); };
    put_contents(folder_ / "few" / "camera.json", "{\"width\": 64");
    EXPECT_NE(error().find("few/camera.json"), std::string::npos) << error();
    put_contents(folder_ / "few" / "camera.json", "{\"width\": \"wide\"}");
    EXPECT_NE(error().find("few/camera.json"), std::string::npos) << error();
    fs::remove_all(folder_ / "few");
    fs::remove(folder_ / "reference.exr");
    EXPECT_NE(error().find("reference.exr"), std::string::npos) << error();
    EXPECT_NE(what_of<UsageError>([&] { planned(scratch_.file("nowhere")); }).find("nowhere"),
              std::string::npos);
}

} // namespace
} // namespace sparselens::lab
