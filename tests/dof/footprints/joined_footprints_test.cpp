// Joined samples hide a lamp as the single samples do: everything that these hide, and hardly more.
#include "base/numbers.h"
#include "dof/footprints/footprint.h"
#include "dof/lens/blocked_fixture.h"
#include "dof/lens/shadow_search.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 1.2, .focal_px = 640, .focus = 5};
constexpr int size = 8;

struct Block : BlockedLdi {
    std::vector<Footprint> of_samples;
    std::vector<JoinedFootprint> of_surfaces;

    explicit Block(const Ldi &from) : BlockedLdi(from, lens) {
        const SampleRun all{samples.blocks[0].begin, samples.blocks[0].end};
        const SamplesInPicture seen{samples.x, samples.y, samples.coc, samples.upper, samples.source};
        of_samples =
            footprints_of(ldi, seen, {Position(0, 0), Position(size - 1, size - 1)}, all, std::span(&all, 1));
        of_surfaces = joined(seen, all, samples.blocks[0].opaque_end, of_samples);
    }
};

// A board of five columns before a wall, and to its right a pixel of partial coverage.
TEST(JoinedFootprints, OfAFlatBoardAreOne) {
    const Ldi ldi = make_ldi(windows_of_size(size, size), rgba_channels(), [](int x, int y) {
        std::vector<Sample> samples;
        if (x < 5) samples.push_back({depth_of(lens, -20), {1, 1, 1, 1}});
        if (x == 6 && y == 2) samples.push_back({depth_of(lens, -20), {0.5f, 0.5f, 0.5f, 0.5f}});
        if (x >= 5) samples.push_back({depth_of(lens, 30), {1, 1, 1, 1}});
        return samples;
    });
    const Block block(ldi);
    ASSERT_EQ(block.of_samples.size(), 65u);
    ASSERT_EQ(block.of_surfaces.size(), 3u);
    const auto &[board, wall, partial] =
        std::array{block.of_surfaces[0], block.of_surfaces[1], block.of_surfaces[2]};
    EXPECT_EQ(board.footprint.place, (std::array{0.0f, 5.0f, 0.0f, 8.0f}));
    EXPECT_EQ(wall.footprint.place, (std::array{5.0f, 8.0f, 0.0f, 8.0f}));
    EXPECT_EQ(partial.footprint.place, (std::array{6.0f, 7.0f, 2.0f, 3.0f}));
    for (const float coc : board.footprint.coc) EXPECT_NEAR(coc, -20, 1e-4);
    EXPECT_EQ(board.depth, block.samples.depth(block.samples.blocks[0].begin));
    EXPECT_LT(block.samples.alpha[partial.sample], 1);
}

// Leaning boards of four columns at several depths, with a slit. Their samples are nearly in the middles of their
// pixels.
Ldi boards(std::uint32_t seed) {
    return make_ldi(windows_of_size(size, size), rgba_channels(), [&](int x, int y) {
        std::vector<Sample> samples;
        const double lean = 0.05 * random_unit(int(seed), 0, 1), beside = 0.1 * random_unit(int(seed), 0, 2);
        if (x != 5 || y < 3)
            samples.push_back({depth_of(lens, -20 * random_unit(x / 4, int(seed), 3) + lean * (x + y)),
                               {1, 1, 1, 1},
                               float(beside * (random_unit(x, y, seed) - 0.5)),
                               float(beside * (random_unit(y, x, seed) - 0.5))});
        samples.push_back({depth_of(lens, 150), {1, 1, 1, 1}});
        return samples;
    });
}

bool hides(const ShadowedLamp &lamp, Footprint footprint, const Imath::V2f &place, float grown) {
    for (std::size_t k = 0; k < 4; ++k) footprint.place[k] += k % 2 == 0 ? -grown : grown;
    return ShadowEdges(lamp, 1, {0, 0}, footprint).shadow().intersects(place);
}

TEST(JoinedFootprints, HideWhatTheirSamplesHide) {
    constexpr float rounding = 1e-3f; // pixels
    constexpr float most =
        1.0f / 8 + 0.01f; // pixels: an edge is at most 3/32 beside a sample's, and its CoC 1/32 off
    int hidden = 0, lit = 0;
    std::size_t samples = 0, surfaces = 0;
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
        const Ldi ldi = boards(seed);
        const Block block(ldi);
        samples += block.of_samples.size(), surfaces += block.of_surfaces.size();
        const Imath::V2d centre(12 * random_unit(int(seed), 1, 7) - 2, 12 * random_unit(int(seed), 2, 7) - 2);
        constexpr double coc = 12;
        const ShadowedLamp lamp{.sample = 0,
                                .lamp = {centre, coc, 1},
                                .origin = {0, 0},
                                .screen = {centre, Imath::V2d(coc), {{-32, -32}, {32, 32}}},
                                .depth = 0,
                                .hardly = 0,
                                .far = 0,
                                .place = {}};
        const float behind = block.samples.depth(0) - 40;
        for (int n = 0; n < 400; ++n) {
            const Imath::V2f at(float(centre.x + coc * 1.4 * (random_unit(n, 1, seed) - 0.5)),
                                float(centre.y + coc * 1.4 * (random_unit(n, 2, seed) - 0.5)));
            const auto by_samples = [&](float grown) {
                for (std::uint32_t i = 0; i < block.of_samples.size(); ++i)
                    if (block.samples.depth(i) > behind && hides(lamp, block.of_samples[i], at, grown))
                        return true;
                return false;
            };
            const bool by_surfaces = std::ranges::any_of(block.of_surfaces, [&](const JoinedFootprint &one) {
                return one.depth > behind && hides(lamp, one.footprint, at, 0);
            });
            ++(by_surfaces ? hidden : lit);
            if (by_samples(-rounding)) {
                EXPECT_TRUE(by_surfaces) << seed << ' ' << at;
            }
            if (by_surfaces) {
                EXPECT_TRUE(by_samples(most)) << seed << ' ' << at;
            }
        }
    }
    EXPECT_GT(hidden, 1000);
    EXPECT_GT(lit, 2000);
    EXPECT_LT(4 * surfaces, samples);
}

} // namespace
} // namespace sparselens
