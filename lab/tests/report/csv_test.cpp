#include "lab/report/csv.h"
#include "lab/tests/report/report_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <sstream>

namespace sparselens::lab {
namespace {

// A plain reader of RFC 4180 without line ends in fields.
std::vector<std::string> fields_of(const std::string &line) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
            fields.back() += line[i++];
        else if (line[i] == '"')
            quoted = !quoted;
        else if (line[i] == ',' && !quoted)
            fields.emplace_back();
        else
            fields.back() += line[i];
    }
    return fields;
}

std::vector<std::map<std::string, std::string>> read(const std::string &csv) {
    std::istringstream lines(csv);
    std::string line;
    std::getline(lines, line);
    const auto names = fields_of(line);
    std::vector<std::map<std::string, std::string>> rows;
    while (std::getline(lines, line)) {
        const auto values = fields_of(line);
        EXPECT_EQ(values.size(), names.size()) << line;
        for (std::size_t i = 0; i < names.size(); ++i)
            EXPECT_TRUE((i ? rows.back() : rows.emplace_back()).emplace(names[i], values[i]).second)
                << names[i];
    }
    return rows;
}

TEST(Csv, GivesEveryFigureOfEveryRegion) {
    ReportRow row = report_row(Role::other, "a \"renderer\", quoted", 2, 5, 37.25);
    row.causes = {45.5, 38.125};
    row.peak_mb = 12.5;
    row.pull = Steadiness{.above = {120, 7}, .largest = 0.25};
    row.errors[0].psnr = std::numeric_limits<double>::infinity();
    row.errors[0].nonfinite_image = 7;
    row.errors[2].ssim = 0.1; // blurred
    row.errors[3].max = std::nan("");
    const auto rows = read(report_as_csv(std::vector{row}));
    ASSERT_EQ(rows.size(), 1u);
    const auto &first = rows[0];
    EXPECT_EQ(first.at("renderer"), "a \"renderer\", quoted");
    EXPECT_EQ(first.at("seconds"), "2");
    EXPECT_EQ(first.at("seconds_render"), "1.5");
    EXPECT_EQ(first.at("seconds_process"), "0.5");
    EXPECT_EQ(first.at("psnr_tonemapped"), "37.25");
    EXPECT_EQ(first.at("psnr"), "inf");
    EXPECT_EQ(first.at("nonfinite_image"), "7");
    EXPECT_EQ(first.at("blurred_ssim"), "0.1");
    EXPECT_EQ(first.at("silhouettes_max"), "");
    EXPECT_EQ(first.at("psnr_sampling"), "45.5");
    EXPECT_EQ(first.at("psnr_layers"), "38.125");
    EXPECT_EQ(first.at("peak_mb"), "12.5");
    EXPECT_EQ(first.at("pull_flickering_pixels"), "120");
    EXPECT_EQ(first.at("pull_sparkling_pixels"), "7");
    EXPECT_EQ(first.at("pull_largest"), "0.25");
    EXPECT_EQ(first.at("equal_error_seconds"), ""); // no ray tracing to compare with
    for (const Figure &figure : figure_table)
        for (const std::string region : {"", "in_focus_", "blurred_", "silhouettes_"})
            EXPECT_TRUE(first.contains(region + figure.name)) << region << figure.name;
}

TEST(Csv, ComparesEachRowWithRayTracingOfItsScene) {
    std::vector<ReportRow> rows = ray_tracing_rows();
    rows.push_back(report_row(Role::sparse_lens, "sparse", 2, 5, 39));
    rows.push_back(report_row(Role::sparse_lens, "sparse", 2, 5, 50));
    std::vector<ReportRow> other = rows; // twice as slow there
    for (ReportRow &row : other) {
        row.scene = "grass";
        if (row.role == Role::ray_tracing)
            for (double &seconds : row.seconds) seconds *= 2;
    }
    rows.insert(rows.end(), other.begin(), other.end());
    ASSERT_EQ(by_scene(rows).size(), 2u);
    const auto read_rows = read(report_as_csv(rows));
    EXPECT_NEAR(std::stod(read_rows[3].at("equal_error_seconds")), 8, 1e-9);
    EXPECT_NEAR(std::stod(read_rows[3].at("equal_error_rays")), 32, 1e-9);
    EXPECT_NEAR(std::stod(read_rows[3].at("equal_time_db")), 6, 1e-9);
    EXPECT_EQ(read_rows[4].at("equal_error_seconds"), ""); // beyond the measured range
    EXPECT_NEAR(std::stod(read_rows[8].at("equal_error_seconds")), 16, 1e-9);
}

TEST(Csv, TimesGivenWithThePicturesHaveNoPeak) {
    ReportRow row = report_row(Role::other, "ready", 2, 5, 37);
    row.runs = 0;
    EXPECT_EQ(read(report_as_csv(std::vector{row}))[0].at("peak_mb"), "");
    EXPECT_EQ(read(report_as_csv(std::vector{row}))[0].at("pull_largest"), "");
    EXPECT_EQ(read(report_as_csv({})).size(), 0u);
}

} // namespace
} // namespace sparselens::lab
