#include "lab/reference/find_fillers_slowly.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <array>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5}; // CoC up to 7.7 px behind focus

void expect_slow(const Ldi &ldi, const Imath::Box2i &known) {
    const LargeArray<Filler> found = find_fillers(ldi, lens, known);
    const std::vector<Filler> slow = find_fillers_slowly(ldi, lens, known);
    ASSERT_EQ(found.size(), slow.size());
    EXPECT_GT(slow.size(), 300u); // otherwise this proves little
    for (std::size_t i = 0; i < slow.size(); ++i) {
        ASSERT_EQ(found[i].pixel, slow[i].pixel);
        ASSERT_EQ(found[i].z, slow[i].z) << found[i].pixel;
        ASSERT_EQ(found[i].count, slow[i].count) << found[i].pixel;
        ASSERT_EQ(found[i].is_between, slow[i].is_between) << found[i].pixel;
        for (std::uint32_t k = 0; k < slow[i].count; ++k) {
            const Filler::Part &part = found[i].part[k], &by_slow = slow[i].part[k];
            ASSERT_EQ(part.sample, by_slow.sample) << found[i].pixel;
            ASSERT_EQ(part.pixel, by_slow.pixel) << found[i].pixel;
            ASSERT_NEAR(part.share, by_slow.share, 1e-6f * by_slow.share) << found[i].pixel;
        }
    }
}

TEST(FindFillersSlowly, RandomSurfaces) {
    for (const bool opaque : {true, false})
        expect_slow(random_surfaces(windows_of_size(70, 50), lens, opaque, 12), {{5, 4}, {60, 45}});
}

// Posts before a wall. Pixels at their edges mix both; in every second row their colour is not a mixture.
TEST(FindFillersSlowly, Mixtures) {
    const Ldi posts = make_ldi(windows_of_size(90, 40), rgba_channels(), [](int x, int y) {
        const bool post = x % 9 > 5, edge = x % 9 == 0 || x % 9 == 5, none = y % 2 == 1;
        if (post) return std::vector<Sample>{{depth_of(lens, -4), {0.8f, 0.1f, 0, 1}}};
        if (edge) return std::vector<Sample>{{depth_of(lens, 4), {0.6f, none ? 0.9f : 0.3667f, 0.3333f, 1}}};
        return std::vector<Sample>{{depth_of(lens, 4), {0.5f, 0.5f, 0.5f, 1}}};
    });
    std::array<int, 2> mixed{0, 0}; // rows with mixtures, and the others
    for (const Filler &filler : find_fillers_slowly(posts, lens, posts.windows.data))
        for (const Filler::Part &part : filler.parts())
            if (part.pixel % 90 % 9 != 0 && part.pixel % 90 % 9 != 5) ++mixed[part.pixel / 90 % 2];
    EXPECT_GT(mixed[0], 50);
    EXPECT_EQ(mixed[1], 0);
    expect_slow(posts, posts.windows.data);
}

} // namespace
} // namespace sparselens
