#include "measure/figures_text.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>

namespace sparselens {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const ErrorFigures some{infinity, 40.123456789, 35, 30.5, 0.25, 1e-7, 0.5, 0.75, nan, 2, 0, 100, 3, 4};

TEST(FiguresText, JsonKeepsAllDigitsAndInfinityIsNull) {
    const auto json = nlohmann::ordered_json::parse(figures_as_json(some, {}));
    const nlohmann::ordered_json expected{{"psnr", nullptr},
                                          {"psnr_tonemapped", 40.123456789},
                                          {"psnr_srgb", 35},
                                          {"psnr_worst", 30.5},
                                          {"relmse", 0.25},
                                          {"smape", 1e-7},
                                          {"ssim", 0.5},
                                          {"ssim_srgb", 0.75},
                                          {"p99", nullptr},
                                          {"max", 2},
                                          {"max_alpha", 0},
                                          {"pixels", 100},
                                          {"nonfinite", {{"image", 3}, {"reference", 4}}}};
    EXPECT_EQ(json, expected); // including the order of the keys
}

TEST(FiguresText, JsonNamesRegions) {
    const std::vector<NamedFigures> regions{{"in_focus", some}, {"blurred", some}};
    const std::string text = figures_as_json(some, regions);
    EXPECT_TRUE(text.ends_with("}\n"));
    const auto json = nlohmann::ordered_json::parse(text),
               whole = nlohmann::ordered_json::parse(figures_as_json(some, {}));
    EXPECT_EQ(json.at("regions").size(), 2u);
    for (const char *region : {"in_focus", "blurred"})
        EXPECT_EQ(json.at("regions").at(region), whole) << region;
    EXPECT_EQ(json.at("psnr_tonemapped"), 40.123456789);
}

TEST(FiguresText, TableHasAColumnARegion) {
    const std::vector<NamedFigures> regions{{"in_focus", some}};
    const std::string table = figures_as_table(some, regions);
    EXPECT_EQ(table.substr(0, table.find('\n')), "                           all  in_focus");
    EXPECT_NE(table.find("\npsnr_tonemapped        40.1235   40.1235\n"), std::string::npos) << table;
    EXPECT_NE(table.find("\np99                          -         -\n"), std::string::npos) << table;
    EXPECT_NE(table.find("\nnonfinite (image)            3         3\n"), std::string::npos) << table;
}

} // namespace
} // namespace sparselens
