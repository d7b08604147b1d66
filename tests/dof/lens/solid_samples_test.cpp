// Solids behind samples as a lens point sees them: closed forms.
#include "dof/lens/fillers.h"
#include "dof/lens/visibility_fixture.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

using Samples = std::vector<Sample>;

const ThinLens &lens = TileFixture::lens;

// Makes the sample solid; the solid's CoC is greater by `coc`.
Sample solid(Sample sample, double coc) {
    sample.solid = coc / (lens.radius * lens.focal_px);
    return sample;
}

// A sample of CoC -4 in one column, solid to -2, before a wall of that CoC or before nothing, all seen through the
// right rim of the lens.
struct SeenSolid {
    TileFixture tile;
    BlockedSamples solids = place_solids(tile.ldi, lens, {}, tile.blocked.samples);

    explicit SeenSolid(const std::optional<double> &wall, double thickness = 2, int column = 10)
        : tile(
              [&](int x, int) {
                  Samples samples;
                  if (x == column) samples.push_back(solid(opaque_at(-4), thickness));
                  if (wall) samples.push_back(opaque_at(*wall));
                  return samples;
              },
              {{1, 0, 0, 0, 1}}) {}

    // The sample seen at column x of a row.
    std::uint32_t seen_at(int x) const { return Seen(tile, solids).front(x, 7); }
};

TEST(SolidSamples, HideWhatLiesAsFarBehindThemAsTheyLieBehindTheirSample) {
    const SeenSolid behind(1);
    EXPECT_EQ(behind.seen_at(6), behind.tile.sample(10, 7));
    EXPECT_EQ(behind.seen_at(8), behind.tile.sample(10, 7));
    EXPECT_EQ(behind.seen_at(9), behind.tile.sample(8, 7));
    const SeenSolid before(-0.5);
    EXPECT_EQ(before.seen_at(8), before.tile.sample(8, 7)); // of CoC -0.5: from 7.5 on
}

TEST(SolidSamples, LeaveWhatIsEmptyEmpty) {
    const SeenSolid left({}, 2, 5); // no sky comes from there; its CoC is 7.7
    EXPECT_EQ(left.seen_at(1), left.tile.sample(5, 7));
    EXPECT_EQ(left.seen_at(3), Seen::nothing);
    const SeenSolid right({}, 2, 20);
    EXPECT_EQ(right.seen_at(18), right.tile.sample(20, 7));
}

TEST(SolidSamples, ThatWouldHideNothingAreNone) {
    EXPECT_EQ(SeenSolid(1).solids.count(), 64u);
    EXPECT_EQ(SeenSolid(1, 6).solids.count(), 0u); // a CoC of 8 and more is behind infinity
    EXPECT_EQ(SeenSolid(1, 0).solids.count(), 0u);
}

// The sample that the only solid shows; empty if there is no solid.
std::optional<std::uint64_t> shown(const std::function<Samples(int x, int y)> &samples_at) {
    const TileFixture tile(samples_at, {});
    const BlockedSamples solids = place_solids(tile.ldi, lens, {}, tile.blocked.samples);
    EXPECT_LE(solids.count(), 1u);
    if (solids.count() == 0) return {};
    return tile.blocked.samples.source[solids.named[0]];
}

TEST(SolidSamples, OfEdgesShowTheNearestOpaqueSampleAround) {
    const auto edge = [](int x, int y, double beside, double farther) {
        if (x == 20 && y == 20) return Samples{solid(partial_at(-4, .7f), 2), opaque_at(5)};
        if (x == 21 && y == 21) return Samples{opaque_at(beside)};
        if (x == 19 && y == 20) return Samples{opaque_at(farther)};
        return Samples{};
    };
    // The samples in order: 19, 20 and the solid's own opaque one in row 20, then the one of row 21.
    EXPECT_EQ(shown([&](int x, int y) { return edge(x, y, -3.5, -3); }), 3u);
    EXPECT_EQ(shown([&](int x, int y) { return edge(x, y, -6, -3); }), 0u);
    EXPECT_EQ(shown([&](int x, int y) { return edge(x, y, -1.5, 0); }), std::nullopt);
}

// A post of CoC -4 in column 10 before a wall of CoC 1, which ends after column `last`; another one is far behind it,
// and is seen in column 6 unless the first one ends at the post.
struct Walls {
    TileFixture tile;
    BlockedSamples solids = place_solids(tile.ldi, lens, find_fillers(tile.ldi, lens, tile.ldi.windows.data),
                                         tile.blocked.samples);

    explicit Walls(int last)
        : tile(
              [&](int x, int) {
                  Samples samples{opaque_at(x == 10 ? -4 : x <= last ? 1 : 5)};
                  if (x == 6 && last > 10) samples.push_back(opaque_at(5));
                  return samples;
              },
              {{1, 0, 0, 0, 1}}) {}
};

TEST(SolidSamples, FillersBetweenTwoEndsOfASurfaceAreSolid) {
    const Walls between(63);
    ASSERT_EQ(between.solids.count(), 64u);
    EXPECT_FLOAT_EQ(between.solids.depth(0), float(disparity(lens, depth_of(lens, 1))) - one_surface_px);
    EXPECT_EQ(Seen(between.tile, {}).front(11, 7), between.tile.sample(6, 7) + 1); // shines through
    EXPECT_EQ(Seen(between.tile, between.solids).front(11, 7), between.tile.sample(9, 7));
    EXPECT_EQ(Walls(9).solids.count(), 0u);
}

TEST(SolidSamples, MirrorsAreNone) {
    const auto mirror = [](int x, int y) {
        Sample sample = solid(opaque_at(-4), 2);
        if (x != 3 || y != 4) return Samples{};
        sample.image_z = depth_of(lens, 3);
        return Samples{sample};
    };
    EXPECT_EQ(shown(mirror), std::nullopt);
}

} // namespace
} // namespace sparselens
