// What holds for every look of the table.
#include "looks/table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace sparselens {
namespace {

// A lens of 50 mm at f/2, with 4 pixels per mm.
const LookContext context{.lens = {.radius = 0.0125, .focal_px = 200, .focus = 4}, .focal_length_mm = 50};

LensLooks acted(const LookNumber &number, double value) {
    LookValues values;
    values.*number.value = value;
    LensLooks looks;
    values.act(context, looks);
    return looks;
}

TEST(LookTable, HasNamesRangesAndControls) {
    for (const LookNumber &number : look_numbers()) {
        EXPECT_TRUE(number.range.holds(number.control.usual)) << number.name;
        EXPECT_FALSE(number.range.holds(NAN)) << number.name;
        EXPECT_NE(std::string(number.help).find("(default: "), std::string::npos) << number.name;
    }
}

// A missing value does nothing, and so does the usual one. Others change the lens.
TEST(LookTable, EachActsOnTheLens) {
    LensLooks none;
    LookValues().act(context, none);
    EXPECT_EQ(none, LensLooks());
    for (const LookNumber &number : look_numbers()) {
        EXPECT_EQ(acted(number, number.control.usual), LensLooks()) << number.name;
        EXPECT_NE(acted(number, number.control.high), LensLooks()) << number.name;
    }
}

} // namespace
} // namespace sparselens
