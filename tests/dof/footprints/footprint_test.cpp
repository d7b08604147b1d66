#include "dof/footprints/footprint.h"
#include "dof/lens/blocked_fixture.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <span>
#include <vector>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 1.2, .focal_px = 640, .focus = 5};
constexpr int size = 12;

// A slope whose samples are anywhere in their pixels, and from column 6 on another surface far behind it.
Ldi slope() {
    return make_ldi(windows_of_size(size, size), rgba_channels(), [&](int x, int y) {
        const double coc = x < 6 ? -20 + 0.6 * x : 30;
        return std::vector<Sample>{{depth_of(lens, coc),
                                    {1, 1, 1, 1},
                                    float(random_unit(x, y, 1) - 0.5),
                                    float(random_unit(x, y, 2) - 0.5)}};
    });
}

TEST(Footprint, SharesItsEdgesWithItsSurfaceAndEndsWhereThatEnds) {
    const Ldi ldi = slope();
    const BlockedSamples blocked = BlockedLdi(ldi, lens).samples;
    const std::uint32_t count = std::uint32_t(blocked.count());
    const SampleRun all{0, count};
    const std::vector<Footprint> footprints =
        footprints_of(ldi, {blocked.x, blocked.y, blocked.coc, blocked.upper, blocked.source},
                      {Position(0, 0), Position(size - 1, size - 1)}, all, std::span(&all, 1));
    std::vector<std::uint32_t> places(count);
    for (std::uint32_t i = 0; i < count; ++i) places[blocked.source[i]] = i;
    const auto at = [&](int x, int y) { return footprints[places[std::size_t(y * size + x)]]; };
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const Footprint f = at(x, y);
            const std::uint32_t own = places[std::size_t(y * size + x)];
            if (x + 1 < size && x != 5) {
                EXPECT_EQ(f.place[1], at(x + 1, y).place[0]);
                EXPECT_EQ(f.coc[1], at(x + 1, y).coc[0]);
            } else {
                EXPECT_EQ(f.place[1], blocked.x[own] + 0.5f);
                EXPECT_EQ(f.coc[1], blocked.coc[own]);
            }
            if (y + 1 < size) {
                EXPECT_EQ(f.place[3], at(x, y + 1).place[2]);
                EXPECT_EQ(f.coc[3], at(x, y + 1).coc[2]);
            }
            EXPECT_TRUE(x != 6 || f.place[0] == blocked.x[own] - 0.5f);
        }
}

// The surface has columns 0 to 5, leans by more than a pixel of CoC per column, and ends before a wall.
TEST(Footprint, OfASteepSurfaceSharesItsEdgesWhereThatGoesOn) {
    const Ldi ldi = make_ldi(windows_of_size(size, size), rgba_channels(), [&](int x, int) {
        return std::vector<Sample>{{depth_of(lens, x < 6 ? -20 + 3 * x : 30), {1, 1, 1, 1}}};
    });
    const Links links(ldi, lens);
    const BlockedSamples blocked = BlockedLdi(ldi, lens).samples;
    const SampleRun all{0, std::uint32_t(blocked.count())};
    const PositionBox pixels{Position(0, 0), Position(size - 1, size - 1)};
    const SamplesInPicture alone{blocked.x, blocked.y, blocked.coc, blocked.upper, blocked.source};
    SamplesInPicture joined = alone;
    joined.links = &links;
    const auto footprints = footprints_of(ldi, joined, pixels, all, std::span(&all, 1));
    const auto parted = footprints_of(ldi, alone, pixels, all, std::span(&all, 1));
    for (std::uint32_t i = 0; i < blocked.count(); ++i) {
        const bool goes_on = blocked.x[i]<5, goes_back = blocked.x[i]> 1 && blocked.x[i] < 6;
        EXPECT_NEAR(footprints[i].coc[1], blocked.coc[i] + (goes_on ? 1.5f : 0.0f), 1e-4) << blocked.x[i];
        EXPECT_NEAR(footprints[i].coc[0], blocked.coc[i] - (goes_back ? 1.5f : 0.0f), 1e-4) << blocked.x[i];
        EXPECT_EQ(parted[i].coc[1], blocked.coc[i]);
        EXPECT_EQ(footprints[i].place, parted[i].place);
    }
    EXPECT_NEAR(coc_to_edges(&links, pixels), 1.5, 1e-5);
    EXPECT_EQ(coc_to_edges(&links, {Position(8, 0), Position(size - 1, size - 1)}), 0.5f);
    EXPECT_EQ(coc_to_edges(nullptr, pixels), 0.5f);
}

} // namespace
} // namespace sparselens
