#include "base/image.h"

#include <gtest/gtest.h>

#include <numeric>
#include <string>

namespace sparselens {
namespace {

TEST(LargeArray, KeepsWhatItHasWhenItGrows) {
    LargeArray<int> array(100);
    std::iota(array.begin(), array.end(), 0);
    array.resize(100000);
    for (int i = 0; i < 100; ++i) EXPECT_EQ(array[std::size_t(i)], i);
}

TEST(LargeArray, IsSetToAValueThatIsGiven) {
    const LargeArray<float> array(5, 2.5f);
    EXPECT_EQ(array, LargeArray<float>({2.5f, 2.5f, 2.5f, 2.5f, 2.5f}));
}

TEST(LargeArray, MakesWhatMakesItself) {
    EXPECT_EQ(LargeArray<std::string>(2), LargeArray<std::string>(2, ""));
}

} // namespace
} // namespace sparselens
