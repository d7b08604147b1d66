#include "lab/report/answers.h"
#include "lab/report/plot.h"
#include "lab/tests/report/report_rows.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sparselens::lab {
namespace {

ReportRow row(const std::string &renderer, const std::string &processor, double rays, double quality) {
    ReportRow made = report_row(Role::other, renderer, 1, rays, quality);
    made.processor = processor;
    return made;
}

std::vector<Answer> answers_of(const std::vector<ReportRow> &rows) {
    const std::vector<std::span<const ReportRow>> scenes{rows};
    return answers(scenes);
}

const Answer &about(const std::vector<Answer> &all, const std::string &word) {
    const auto found = std::ranges::find_if(
        all, [&](const Answer &a) { return a.question.find(word) != std::string::npos; });
    if (found == all.end()) throw std::runtime_error("no answer about " + word);
    return *found;
}

TEST(Answers, TellAtWhichRaysTheDenoiserIsBetter) {
    const auto all =
        answers_of({row("centre + 4", "lens normal", 5, 30), row("centre + 4", "lens normal", 80, 40),
                    row("denoised ray tracing", "", 5, 28), row("denoised ray tracing", "", 80, 42.5)});
    EXPECT_EQ(about(all, "Denoised").losses, "fence at 80 rays (up to 2.5 dB)");
    EXPECT_EQ(about(all, "Denoised").gains, "fence at 5 rays (up to 2.0 dB)");
    EXPECT_EQ(std::ranges::count_if(all, [](const Answer &a) { return a.question.starts_with("Averages"); }),
              0);
}

// Denoised views may count as the better ones, because denoising needs no rays.
TEST(Answers, ViewsMayBeDenoisedToo) {
    const auto all =
        answers_of({row("centre + 4", "lens normal", 5, 30), row("centre + 4 denoised", "lens normal", 5, 33),
                    row("denoised ray tracing", "", 5, 32), row("accumulated lens views", "", 5, 31)});
    EXPECT_EQ(about(all, "Denoised").losses, "nowhere");
    EXPECT_EQ(about(all, "Denoised").gains, "fence at 5 rays (up to 1.0 dB)");
    EXPECT_EQ(about(all, "Averages").losses, "fence at 5 rays (up to 1.0 dB)"); // of plain views
}

TEST(Answers, BetweenTheBudgetsOfTheOthersTheirCurveIsTaken) {
    std::vector<ReportRow> rows = ray_tracing_rows(); // 36 dB at 16 rays, 42 at 64
    rows.push_back(row("centre + 4", "lens normal", 32, 40));
    rows.push_back(row("centre + 4", "lens normal", 320, 50)); // ray tracing was not measured there
    EXPECT_EQ(about(answers_of(rows), "Ray tracing").gains, "fence at 32 rays (up to 1.0 dB)");
    EXPECT_EQ(about(answers_of(rows), "Ray tracing").losses, "nowhere");
    EXPECT_EQ(about(answers_of(rows), "note").gains.substr(0, 39), "fence: 0.25 s and no ray; ray tracing o");
}

TEST(Answers, ProgramsOfOneViewAreComparedWithOneView) {
    const auto all = answers_of({row("one view", "lens normal", 16, 32), row("one view", "gather", 16, 40),
                                 row("one view", "Theirs (as it is)", 16, 25),
                                 row("one view", "Theirs (at best)", 16, 33.25)});
    EXPECT_EQ(about(all, "programs").losses, "fence: Theirs (at best) has 33.2 dB, this one 32.0");
    EXPECT_EQ(about(all, "programs").gains, "nowhere");
}

TEST(Plot, ShowsSixWaysThatAreInUse) {
    std::vector<ReportRow> rows;
    for (const char *of_literature :
         {"one view, scatter", "centre + 4, selective K=8", "4 strata, layered blend",
          "one view, lens normal", "accumulated lens views", "distributed ray tracing",
          "denoised ray tracing", "centre + 4, lens normal", "centre + 8, lens normal",
          "centre + 4 denoised, lens normal"}) {
        const std::string name = of_literature;
        const auto comma = name.find(", ");
        rows.push_back(
            row(name.substr(0, comma), comma == std::string::npos ? "" : name.substr(comma + 2), 5, 30));
    }
    const std::vector<ReportRow> kept = rows_in_use(rows);
    ASSERT_EQ(kept.size(), 6u);
    EXPECT_EQ(method_name(kept.front()), "one view, lens normal"); // in the order of the rows
    for (const ReportRow &one : kept) EXPECT_NE(one.processor, "scatter");
}

} // namespace
} // namespace sparselens::lab
