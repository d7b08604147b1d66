#include "base/error.h"
#include "chain/parameters.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace sparselens {
namespace {

TEST(Parameters, HaveOneRowEach) {
    std::set<std::string> names;
    for (const Parameter *row : picture_parameters()) {
        EXPECT_TRUE(names.insert(row->name).second) << row->name;
        EXPECT_EQ(find_parameter(row->name), row);
        EXPECT_FALSE(row->help.empty()) << row->name;
        EXPECT_EQ(row->unit.empty(), row->form == ParameterForm::flag || row->form == ParameterForm::device)
            << row->name;
        EXPECT_EQ(row->words.empty(), row->form != ParameterForm::word) << row->name;
    }
    EXPECT_EQ(find_parameter("no-such"), nullptr);
    EXPECT_EQ(find_parameter("lens_radius"), nullptr); // a keyword
}

TEST(Parameters, NumbersMayHaveOneSign) {
    std::array<double, 2> numbers{};
    EXPECT_TRUE(read_numbers("+1.5,-2", numbers));
    EXPECT_EQ(numbers, (std::array<double, 2>{1.5, -2}));
    for (const char *wrong : {"+-1,2", "++1,2", "--1,2", "+,2", "1", "1,2,3", "1,2 "})
        EXPECT_FALSE(read_numbers(wrong, numbers)) << wrong;
}

TEST(Parameters, LooksHaveControls) {
    for (const auto table : {look_numbers(), highlight_numbers()})
        for (const LookNumber &number : table) {
            const Parameter *row = find_parameter(number.name);
            ASSERT_NE(row, nullptr) << number.name;
            EXPECT_TRUE(row->page) << number.name;
            EXPECT_NE(*row->control.label, '\0') << number.name;
            EXPECT_LT(row->control.low, row->control.high) << number.name;
            for (const double value : {row->control.low, row->control.usual, row->control.high})
                EXPECT_TRUE(row->range.holds(value) || row->control.low == value) << number.name;
        }
}

template <typename Values>
bool put(ParameterRows<Values> rows, const std::string &name, Values &values, const std::string &value) {
    for (const ParameterOf<Values> &row : rows)
        if (row.name == name) return row.put(values, value);
    ADD_FAILURE() << name;
    return false;
}

TEST(Parameters, PutTheirValues) {
    PictureRequest request;
    EXPECT_TRUE(put(gather_parameters(), "quality", request, "final"));
    EXPECT_EQ(request.picture.gather.lens.quality, Quality::final);
    EXPECT_FALSE(request.any_quality);
    EXPECT_TRUE(put(gather_parameters(), "blur", request, "40"));
    EXPECT_EQ(request.blur->in_pixels(4000), 40);
    EXPECT_TRUE(put(gather_parameters(), "blur", request, "2.5%"));
    EXPECT_EQ(request.blur->in_pixels(4000), 100);
    for (const char *wrong : {"2%%", "%", "-2%", "2 %", "nan%"})
        EXPECT_FALSE(put(gather_parameters(), "blur", request, wrong)) << wrong;
    EXPECT_TRUE(put(gather_parameters(), "method", request, "selective"));
    EXPECT_EQ(request.picture.method, &gather_methods()[1]);
    EXPECT_TRUE(put(shown_parameters(), "show", request, "coc"));
    EXPECT_EQ(request.show, Show::coc);
    EXPECT_TRUE(put(shown_parameters(), "lens-point", request, "0.71,0.71"));
    EXPECT_DOUBLE_EQ(request.picture.gather.lens.point->length(), 1);
    EXPECT_FALSE(put(shown_parameters(), "lens-point", request, "0.8,0.8"));
    EXPECT_TRUE(put(lens_parameters(), "fstop", request.lens, "2.8"));
    EXPECT_EQ(request.lens.fstop, 2.8);
    EXPECT_TRUE(put(look_parameters(), "cat-eye", request.looks, "1.5"));
    EXPECT_EQ(request.looks.values.cat_eye, 1.5);
    EXPECT_TRUE(put(look_parameters(), "axial-chromatic-type", request.looks, "blue-yellow"));
    EXPECT_EQ(request.looks.values.chromatic_type, ChromaticType::blue_yellow);
    EXPECT_TRUE(put(look_parameters(), "tilt", request.looks, "5,-3"));
    EXPECT_EQ(request.looks.values.tilt_y, -3);
    EXPECT_FALSE(put(look_parameters(), "tilt", request.looks, "0,90"));
    EXPECT_TRUE(put(depth_parameters(), "depth", request.depth, "hyperbolic"));
    EXPECT_EQ(request.depth.meaning, DepthMeaning::hyperbolic);
    EXPECT_TRUE(put(window_parameters(), "overscan", request.windows, "crop"));
    EXPECT_EQ(request.windows.overscan, OutputOverscan::crop);
    EXPECT_TRUE(put(window_parameters(), "pixel-filter", request.windows, "gaussian:2"));
    EXPECT_EQ(request.windows.filter, pixel_filter_of("gaussian:2"));
    EXPECT_FALSE(put(window_parameters(), "pixel-filter", request.windows, "round"));
}

TEST(Parameters, ExcludeAndNeedOthers) {
    const auto says = [](const std::set<std::string> &given) {
        return what_of<UsageError>(
            [&] { check_together([&](const std::string &name) { return given.contains(name); }); });
    };
    EXPECT_EQ(says({"fstop", "focus_distance", "blades"}), "(nothing was thrown)");
    EXPECT_EQ(says({"fstop", "lens_radius"}), "`lens_radius`: is given with `fstop`; give one of the two");
    EXPECT_EQ(says({"aperture", "blade_rotation"}),
              "`aperture`: is given with `blade_rotation`; give one of the two");
    EXPECT_EQ(says({"highlight_knee"}), "`highlight_gain`: is needed by `highlight_knee`");
    EXPECT_EQ(says({"highlight_knee", "highlight_gain"}), "(nothing was thrown)");
    EXPECT_TRUE(exclude("focus-distance", "focus-pixel") && exclude("focus-pixel", "focus-distance"));
    EXPECT_FALSE(exclude("fstop", "blades"));
    EXPECT_TRUE(needs("holdout-defocused", "holdout") && !needs("holdout", "holdout-defocused"));
}

} // namespace
} // namespace sparselens
