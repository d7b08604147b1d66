// insert_samples() against an LDI that is built anew.
#include "deep/build.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace sparselens {
namespace {

Ldi random_ldi(std::mt19937 &random, std::size_t pixels) {
    Ldi ldi;
    ldi.windows = windows_of_size(int(pixels), 1);
    ldi.channels = {{"R", PixelType::half}, {"A", PixelType::half}};
    ldi.values.resize(2);
    ldi.begin = {0};
    for (std::size_t p = 0; p < pixels; ++p) {
        for (unsigned n = unsigned(random()) % 4; n > 0; --n) {
            ldi.z.push_back(float(ldi.z.size() + 1));
            ldi.weight.push_back(float(random() % 9 + 1));
            for (std::vector<float> &values : ldi.values) values.push_back(float(random() % 100));
        }
        ldi.begin.push_back(ldi.z.size());
    }
    return ldi;
}

TEST(InsertSamples, EqualAnLdiThatIsBuiltAnew) {
    std::mt19937 random(7);
    for (int round = 0; round < 50; ++round) {
        Ldi ldi = random_ldi(random, 12);
        Ldi added = random_ldi(random, 0);
        const Ldi built = build_by_pixels(ldi, [&](std::size_t pixel, Ldi &out) {
            const SampleRange there = ldi.pixel(pixel);
            for (std::uint64_t i = there.from; i <= there.to; ++i) {
                const float z = float(i) + 0.5f * float(random() % 2); // as the sample before, or behind it
                for (unsigned n = unsigned(random()) % 3; n > 0; --n) {
                    const float value = float(added.z.size());
                    for (Ldi *to : {&out, &added}) {
                        to->z.push_back(z);
                        to->weight.push_back(value);
                        for (std::vector<float> &values : to->values) values.push_back(value);
                    }
                    ++out.begin.back();
                }
                if (i < there.to) append(out, ldi, i);
            }
            added.begin.push_back(added.z.size());
        });
        insert_samples(ldi, added);
        EXPECT_EQ(ldi.begin, built.begin);
        EXPECT_EQ(ldi.z, built.z);
        EXPECT_EQ(ldi.weight, built.weight);
        EXPECT_EQ(ldi.values, built.values);
    }
}

} // namespace
} // namespace sparselens
