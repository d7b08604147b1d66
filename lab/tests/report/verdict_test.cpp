#include "lab/report/verdict.h"
#include "lab/tests/report/report_rows.h"

#include <gtest/gtest.h>

namespace sparselens::lab {
namespace {

std::vector<ReportRow> with(std::vector<ReportRow> more) {
    std::vector<ReportRow> rows = ray_tracing_rows();
    rows.insert(rows.end(), more.begin(), more.end());
    return rows;
}

std::string text_of(const std::vector<ReportRow> &rows) {
    std::string text;
    for (const std::string &sentence : verdict_sentences(rows, scene_verdict(rows))) text += sentence + '\n';
    return text;
}

bool says(const std::string &text, const std::string &what) { return text.find(what) != std::string::npos; }

TEST(Verdict, EqualErrorAndEqualTimeAreReadOffTheCurve) {
    const auto rows = with({report_row(Role::sparse_lens, "sparse", 2, 5, 39)});
    const RowVerdict verdict = row_verdict(rows.back(), ray_tracing_curves(rows));
    EXPECT_EQ(verdict.seconds.bound, Reached::exactly);
    EXPECT_NEAR(verdict.seconds.cost, 8, 1e-9); // four times as long
    EXPECT_NEAR(verdict.rays.cost, 32, 1e-9);
    EXPECT_NEAR(*verdict.equal_time, 6, 1e-9);
    EXPECT_EQ(reached_text(verdict.seconds, 2), "4");
}

TEST(Verdict, WhatWasNotMeasuredIsABoundOrNothing) {
    const auto rows = with({report_row(Role::sparse_lens, "sparse", 0.5, 5, 29),
                            report_row(Role::sparse_lens, "sparse", 20, 80, 43)});
    const RayTracingCurves curves = ray_tracing_curves(rows);
    const RowVerdict quick = row_verdict(rows[3], curves), good = row_verdict(rows[4], curves);
    EXPECT_FALSE(quick.equal_time);
    EXPECT_FALSE(good.equal_time);
    EXPECT_EQ(reached_text(quick.seconds), "< 1");
    EXPECT_EQ(reached_text(good.rays), "> 64");
    EXPECT_EQ(reached_text({}), "-");
}

TEST(Verdict, CrossingIsWhereRayTracingPassesTheBestSparseRow) {
    const auto rows = with({report_row(Role::sparse_lens, "sparse", 2, 5, 37),
                            report_row(Role::sparse_lens, "sparse", 3, 20, 39),
                            report_row(Role::other, "strata", 3, 20, 41)});
    const SceneVerdict verdict = scene_verdict(rows);
    EXPECT_EQ(verdict.best, 4u);
    EXPECT_NEAR(verdict.crossing_seconds.cost, 8, 1e-9);
    EXPECT_NEAR(verdict.crossing_rays.cost, 32, 1e-9);
    EXPECT_EQ(verdict.below, 2u);
    EXPECT_TRUE(says(text_of(rows), "passes it at 8 s, 32 rays a pixel"));
}

TEST(Verdict, NamesWhereRayTracingIsBetter) {
    // Ray tracing needs 6.3 s for 38 dB, so the row of 10 s is of no use.
    const auto rows = with({report_row(Role::sparse_lens, "quick", 2, 5, 37),
                            report_row(Role::sparse_lens, "slow", 10, 40, 38)});
    const SceneVerdict verdict = scene_verdict(rows);
    ASSERT_EQ(verdict.slower.size(), 1u);
    EXPECT_EQ(verdict.slower[0], 4u);
    EXPECT_TRUE(says(text_of(rows), "the better choice: slow, lens at 40 rays."));
    EXPECT_EQ(verdict.below, 1u); // the other one is not compared further
}

TEST(Verdict, RayTracingThatIsBetterFromTheStartIsSaidToBe) {
    const auto rows = with({report_row(Role::sparse_lens, "sparse", 2, 5, 29)});
    EXPECT_TRUE(says(text_of(rows), "better from its smallest measured budget on"));
    const auto never = with({report_row(Role::sparse_lens, "sparse", 2, 5, 50)});
    EXPECT_TRUE(
        says(text_of(never), "does not reach it with the largest measured budget (16 s, 64 rays a pixel)."));
    const auto longer = with({report_row(Role::sparse_lens, "sparse", 20, 5, 50)});
    EXPECT_TRUE(says(text_of(longer), "which of the two is better there was not measured"));
}

TEST(Verdict, RowsThatOthersBeatAreNamed) {
    const ReportRow sparse = report_row(Role::sparse_lens, "sparse", 2, 5, 37),
                    best = report_row(Role::sparse_lens, "sparse", 3, 20, 40);
    const auto beaten = [&](const std::vector<ReportRow> &others) {
        auto rows = with({sparse, best});
        rows.insert(rows.end(), others.begin(), others.end());
        return scene_verdict(rows).beaten;
    };
    EXPECT_TRUE(beaten({}).empty());
    EXPECT_TRUE(beaten({report_row(Role::other, "faster but worse", 1, 5, 36)}).empty());
    EXPECT_TRUE(beaten({report_row(Role::other, "better but slower", 2.5, 5, 39)}).empty());
    EXPECT_TRUE(beaten({report_row(Role::other, "the same", 2, 5, 37)}).empty());
    EXPECT_TRUE(beaten({report_row(Role::sparse_lens, "one of ours", 1.9, 5, 38)}).empty());
    const auto found = beaten({report_row(Role::other, "as fast and better", 2, 5, 38),
                               report_row(Role::other, "faster and better still", 1, 5, 39)});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].row, 3u);
    EXPECT_EQ(found[0].by, 6u);
    EXPECT_EQ(found[0].others, 1u);
}

TEST(Verdict, ClaimsNothingWhereNothingWasMeasured) {
    EXPECT_TRUE(says(text_of(ray_tracing_rows()), "No sparse views seen through the lens were measured."));
    EXPECT_TRUE(says(text_of({report_row(Role::sparse_lens, "sparse", 2, 5, 37)}),
                     "No ray tracing of the lens was measured."));
    // The only row takes longer than the crossing, so the verdict does not mention slower rows.
    const auto slow = with({report_row(Role::sparse_lens, "slow", 10, 40, 38)});
    EXPECT_TRUE(says(text_of(slow), "No sparse row with the lens gather takes less time than that."));
}

} // namespace
} // namespace sparselens::lab
