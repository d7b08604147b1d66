#include "measure/figures_text.h"

#include <gtest/gtest.h>

#include <limits>

namespace sparselens {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const ErrorFigures some{infinity, 40.123456789, 0.25, 1e-7, 0.5, nan, 2, 0, 100, 3, 4};

TEST(FiguresText, JsonKeepsAllDigitsAndInfinityIsNull) {
    EXPECT_EQ(figures_as_json(some, {}), "{\n"
                                         "  \"psnr\": null,\n"
                                         "  \"psnr_tonemapped\": 40.123456789,\n"
                                         "  \"relmse\": 0.25,\n"
                                         "  \"smape\": 1e-07,\n"
                                         "  \"ssim\": 0.5,\n"
                                         "  \"p99\": null,\n"
                                         "  \"max\": 2,\n"
                                         "  \"max_alpha\": 0,\n"
                                         "  \"pixels\": 100,\n"
                                         "  \"nonfinite\": {\"image\": 3, \"reference\": 4}\n"
                                         "}\n");
}

TEST(FiguresText, JsonNamesRegions) {
    const std::vector<NamedFigures> regions{{"in_focus", some}, {"blurred", some}};
    const std::string json = figures_as_json(some, regions);
    EXPECT_NE(json.find("\"regions\": {\n    \"in_focus\": {\n      \"psnr\": null"), std::string::npos);
    EXPECT_NE(json.find("    },\n    \"blurred\": {"), std::string::npos);
    EXPECT_TRUE(json.ends_with("\n    }\n  }\n}\n"));
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
