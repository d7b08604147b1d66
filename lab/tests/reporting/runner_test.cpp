#include "base/error.h"
#include "lab/reporting/files.h"
#include "lab/reporting/process.h"
#include "lab/reporting/runner.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>

namespace sparselens::lab {
namespace {

namespace fs = std::filesystem;

// A folder of tools that are shell scripts, and a folder for a report.
class RunnerTest : public testing::Test {
protected:
    RunnerTest() {
        fs::create_directories(scratch_.file("tools"));
        fs::create_directories(scratch_.file("report"));
        tool("note", "echo ran >>log; echo \"$1\" >\"$2\"");
    }

    void tool(const std::string &name, const std::string &script) {
        const std::string path = scratch_.file("tools/" + name);
        put_contents(path, "#!/bin/sh\n" + script + "\n");
        fs::permissions(path, fs::perms::owner_all);
    }

    std::vector<StepTimes> run(const std::vector<Step> &steps, int runs = 1, double enough = 1000) {
        const RunOptions options{scratch_.file("tools"), scratch_.file("report"), 2, runs, enough};
        return run_steps(steps, options, ToolContext{});
    }

    // How often the tool "note" has run since last asked.
    std::size_t noted() {
        const std::string text = contents_of(scratch_.file("report/log"));
        fs::remove(scratch_.file("report/log"));
        return std::size_t(std::ranges::count(text, '\n'));
    }

    std::string report(const std::string &file) const { return scratch_.file("report/" + file); }

    ScratchFolder scratch_;
};

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// A shell script that writes a tracer's camera.json: the centre view took `seconds`.
std::string tracing(const std::string &seconds) {
    return "echo \"{\\\"width\\\": 1, \\\"height\\\": 1, \\\"focal_mm\\\": 1, \\\"sensor_width_mm\\\": 1, "
           "\\\"focus_distance\\\": null, \\\"lens_radius\\\": 0, \\\"views\\\": [], \\\"view_spp\\\": 1, "
           "\\\"seconds\\\": {\\\"center.exr\\\": " +
           seconds + "}}\" >views/camera.json";
}

// The seconds of its centre view are subtracted.
Step tracing_step() {
    return {.name = "trace",
            .commands = {{Stage::render, {"trace"}}},
            .fresh = "views",
            .traced = "views",
            .uncounted = {"center.exr", "not there.exr"}};
}

Step noting(const std::string &text, const std::string &file) {
    return {.name = "steps of/" + file, .commands = {{Stage::warp, {"note", text, file}}}, .outputs = {file}};
}

TEST_F(RunnerTest, DoesNotRunAgainWhatIsDone) {
    const auto first = run({noting("a", "out")});
    EXPECT_EQ(noted(), 1u);
    EXPECT_EQ(contents_of(report("out")), "a\n");
    EXPECT_GT(first[0].seconds[std::size_t(Stage::warp)], 0);
    EXPECT_EQ(first[0].seconds[std::size_t(Stage::render)], 0);
    EXPECT_GT(first[0].peak_mb, 0);
    const auto second = run({noting("a", "out")});
    EXPECT_EQ(noted(), 0u);
    EXPECT_EQ(second[0].seconds, first[0].seconds);
    EXPECT_EQ(second[0].peak_mb, first[0].peak_mb);
    EXPECT_EQ(second[0].runs, 1);
}

TEST_F(RunnerTest, RunsAgainWhatIsNoLongerTheSame) {
    put_contents(scratch_.file("given"), "1");
    Step step = noting("a", "out");
    step.given = {scratch_.file("given")};
    run({step});
    EXPECT_EQ(noted(), 1u);
    put_contents(scratch_.file("given"), "22");
    run({step});
    EXPECT_EQ(noted(), 1u) << "another input";
    step.commands[0].words[1] = "b";
    run({step});
    EXPECT_EQ(noted(), 1u) << "another command";
    fs::remove(report("out"));
    run({step});
    EXPECT_EQ(noted(), 1u) << "its output is gone";
    put_contents(report("steps/steps of/out.json"), "{\"identity\": 3");
    run({step});
    EXPECT_EQ(noted(), 1u) << "a damaged record";
    tool("note", "echo ran >>log; echo \"$1\" >\"$2\" # rebuilt");
    run({step});
    EXPECT_EQ(noted(), 1u) << "another program";
    run({step}, 2);
    EXPECT_EQ(noted(), 2u) << "more runs";
    run({step}, 2);
    EXPECT_EQ(noted(), 0u);
}

TEST_F(RunnerTest, RunsAgainWhatReadsWhatIsNoLongerTheSame) {
    Step second = noting("b", "second"), third = noting("c", "third");
    second.inputs = {0};
    run({noting("a", "first"), second, third});
    EXPECT_EQ(noted(), 3u);
    run({noting("changed", "first"), second, third});
    EXPECT_EQ(noted(), 2u);
}

TEST_F(RunnerTest, GoesOnWhereItStopped) {
    tool("broken", "echo 'broken: no' >&2; echo 'broken: not at all' >&2; exit 3");
    const Step broken{.name = "broken", .commands = {{Stage::warp, {"broken", "x y"}}}};
    const std::string error = what_of<Error>([&] {
        run({noting("a", "first"), broken, noting("c", "third")});
    });
    EXPECT_NE(error.find("broken x y --threads 2: exit code 3: broken: not at all"), std::string::npos)
        << error;
    EXPECT_EQ(noted(), 1u);
    tool("broken", "true");
    run({noting("a", "first"), broken, noting("c", "third")});
    EXPECT_EQ(noted(), 1u);
}

TEST_F(RunnerTest, TimesAreMediansOfSeveralRuns) {
    // Each run reports thousands of seconds of unneeded rendering, 3000 on average, which are subtracted.
    tool("trace", "echo ran >>log; " +
                      tracing("$(case $(wc -l <log) in 1) echo 1000;; 2) echo 6000;; *) echo 2000;; esac)"));
    const Clock::time_point start = Clock::now();
    const auto times = run({tracing_step()}, 3);
    EXPECT_EQ(noted(), 3u);
    EXPECT_EQ(times[0].runs, 3);
    EXPECT_GE(times[0].seconds[0], -2000);
    EXPECT_LE(times[0].seconds[0], -2000 + since(start));

    Step untimed = noting("a", "untimed");
    untimed.timed = false;
    run({untimed}, 3);
    EXPECT_EQ(noted(), 1u);
    const auto long_enough = run({noting("a", "long enough")}, 3, 1e-9);
    EXPECT_EQ(noted(), 1u);
    EXPECT_EQ(long_enough[0].runs, 1);
}

TEST_F(RunnerTest, TakesOffWhatWasRenderedForNothing) {
    tool("trace", "sleep 0.2; " + tracing("1000"));
    const Clock::time_point start = Clock::now();
    const double seconds = run({tracing_step()})[0].seconds[0];
    EXPECT_GE(seconds, 0.2 - 1000);
    EXPECT_LE(seconds, since(start) - 1000);
}

TEST_F(RunnerTest, FoldersAreEmptiedBeforeAndScratchIsGoneAfter) {
    tool("make", "[ -z \"$(ls kept)\" ] || exit 1; touch kept/view_1.exr kept/view_0.exr");
    tool("list", "echo \"$@\" >listed");
    fs::create_directories(report("kept"));
    put_contents(report("kept/view_9.exr"), "stale");
    Step step{.name = "make and list",
              .commands = {{Stage::render, {"make"}},
                           {Stage::process, {"list", "a*b/c", "kept/view_*.exr", "none/*"}}},
              .fresh = "kept"};
    run({step});
    EXPECT_EQ(contents_of(report("listed")), "a*b/c kept/view_0.exr kept/view_1.exr --threads 2\n");
    EXPECT_TRUE(fs::exists(report("kept/view_0.exr")));
    step.name = "scratch";
    step.scratch = true;
    run({step});
    EXPECT_FALSE(fs::exists(report("kept")));
}

TEST(StepList, KeepsAStepOfANameOnce) {
    StepList list;
    EXPECT_EQ(list.add(noting("a", "first")), 0u);
    EXPECT_EQ(list.add(noting("b", "second")), 1u);
    EXPECT_EQ(list.add(noting("a", "first")), 0u);
    EXPECT_EQ(list.steps().size(), 2u);
}

TEST(Process, FileNamesNeedNoQuoting) {
    const ScratchFolder scratch;
    const std::string name = "a 'quoted' $(name) \"\n;";
    run_process({"touch", name, "-"}, scratch.file(""));
    EXPECT_TRUE(fs::exists(scratch.file(name)));
}

TEST(Process, FailuresAreErrors) {
    const ScratchFolder scratch;
    const auto error_of = [&](std::vector<std::string> command) {
        return what_of<Error>([&] { run_process(command, scratch.file("")); });
    };
    EXPECT_NE(error_of({"/no/such/program"}).find("/no/such/program: cannot be started"), std::string::npos);
    EXPECT_NE(error_of({"false"}).find("exit code 1"), std::string::npos);
    EXPECT_NE(error_of({"sh", "-c", "kill -9 $$"}).find("signal 9"), std::string::npos);
}

TEST(Process, TellsTimeAndMemory) {
    const ScratchFolder scratch;
    EXPECT_GE(run_process({"sleep", "0.1"}, scratch.file("")).seconds, 0.1);
    // The memory of this process counts for its child too, until the child has started another program.
    rusage own{};
    getrusage(RUSAGE_SELF, &own);
    const long mebibytes = own.ru_maxrss / 1024 + 400;
    const double little = run_process({"true"}, scratch.file("")).peak_mb;
    const double much = run_process({"dd", "if=/dev/zero", "of=/dev/null",
                                     "bs=" + std::to_string(mebibytes) + "M", "count=1"},
                                    scratch.file(""))
                            .peak_mb;
    EXPECT_GT(much, double(mebibytes) - 10);
    EXPECT_LT(little, double(mebibytes) - 10);
}

} // namespace
} // namespace sparselens::lab
