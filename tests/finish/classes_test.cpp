// Classes of equal weight along a measure.
#include "finish/window_means.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

Classes even(std::size_t count) {
    Classes classes(count, 0, 1);
    for (int i = 0; i < 10000; ++i) classes.add((float(i) + 0.5f) / 10000, 1);
    classes.divide();
    return classes;
}

TEST(Classes, EvenValuesMakeEvenClasses) {
    const Classes classes = even(4);
    EXPECT_EQ(classes.of(0.1f), 0u);
    EXPECT_EQ(classes.of(0.26f), 1u);
    EXPECT_EQ(classes.of(0.74f), 2u);
    EXPECT_EQ(classes.of(0.99f), 3u);
    EXPECT_NEAR(classes.place_of(0.375f), 1.5, 0.01);
    EXPECT_NEAR(classes.place_of(0.9f), 3.6, 0.01);
}

TEST(Classes, ValuesBeyondCountAsTheEnds) {
    const Classes classes = even(4);
    EXPECT_EQ(classes.of(-7), 0u);
    EXPECT_EQ(classes.of(7), 3u);
    EXPECT_EQ(classes.place_of(-7), 0);
    EXPECT_EQ(classes.place_of(7), 4);
}

// A hundredth of the pixels has all the weight, and gets half of the classes.
TEST(Classes, PixelsAndWeightsCountHalf) {
    Classes classes(4, 0, 1);
    for (int i = 0; i < 9900; ++i) classes.add(0.4f * float(i) / 9900, 0);
    for (int i = 0; i < 100; ++i) classes.add(0.6f + 0.4f * float(i) / 100, 1);
    classes.divide();
    EXPECT_EQ(classes.of(0.1f), 0u);
    EXPECT_EQ(classes.of(0.3f), 1u);
    EXPECT_EQ(classes.of(0.7f), 2u);
    EXPECT_EQ(classes.of(0.95f), 3u);
}

TEST(Classes, OneValueAndNoneAreFine) {
    Classes one(4, 0, 1), none(4, 0, 1);
    one.add(0.5f, 2);
    one.divide();
    none.divide();
    for (const Classes *classes : {&one, &none})
        for (const float value : {-1.0f, 0.0f, 0.5f, 1.0f}) {
            EXPECT_LT(classes->of(value), 4u);
            EXPECT_GE(classes->place_of(value), 0);
            EXPECT_LE(classes->place_of(value), 4);
        }
}

} // namespace
} // namespace sparselens
