#include "deep/ldi.h"

#include <gtest/gtest.h>

#include <vector>

namespace sparselens {
namespace {

TEST(Ldi, PixelsOwnTheirSamplesInOrder) {
    Ldi ldi;
    ldi.windows = windows_of_size(2, 2);
    ldi.begin = {0, 2, 2, 3, 6};
    ldi.z.resize(6);
    const std::vector<std::vector<std::uint64_t>> expected{{0, 1}, {}, {2}, {3, 4, 5}};
    for (std::size_t pixel = 0; pixel < 4; ++pixel) {
        std::vector<std::uint64_t> samples;
        for (const std::uint64_t i : ldi.pixel(pixel)) samples.push_back(i);
        EXPECT_EQ(samples, expected[pixel]);
        EXPECT_EQ(ldi.pixel(pixel).size(), expected[pixel].size());
        EXPECT_EQ(ldi.pixel(pixel).empty(), expected[pixel].empty());
    }
    EXPECT_EQ(ldi.pixel(3).front(), 3u);
}

} // namespace
} // namespace sparselens
