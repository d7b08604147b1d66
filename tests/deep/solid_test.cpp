// Ldi::solid stays with its samples when they are sorted, merged and dropped.
#include "deep/build.h"
#include "deep/cluster.h"
#include "deep/merge.h"
#include "deep/packed_rows.h"
#include "deep/proxy.h"
#include "deep/sanitize.h"
#include "deep/tidy.h"
#include "dof/merge_layers.h"
#include "support/ldi_samples.h"

#include <gtest/gtest.h>

#include <limits>

namespace sparselens {
namespace {

using Floats = std::vector<float>;

Ldi solid(Ldi ldi, const Floats &values) {
    ldi.solid = values;
    return ldi;
}

Ldi clustered(const Ldi &ldi) {
    Progress silent;
    return cluster(ldi, {.layers = 1}, silent).ldi;
}

TEST(Solid, IsCarriedPixelByPixel) {
    const Ldi ldi = solid(ldi_of({{{.z = 2}, {.z = 3}}, {{.z = 4}}, {{.z = 5}}}), {.1f, .2f, .3f, .4f});
    const auto second = [](std::size_t pixel) { return pixel == 1; };
    const auto drop = [](std::size_t, Ldi &) {};
    Ldi rebuilt = ldi;
    rebuild_pixels(rebuilt, second, drop);
    EXPECT_EQ(rebuilt.solid, (Floats{.1f, .2f, .4f}));
    const auto keep = [&](std::size_t pixel, Ldi &out) {
        for (const std::uint64_t i : ldi.pixel(pixel)) append(out, ldi, i);
    };
    EXPECT_EQ(build_by_pixels(ldi, keep).solid, ldi.solid);
    EXPECT_EQ(without_channels(ldi).solid, ldi.solid);
    PackedRows rows(ldi.windows);
    rows.append(ldi);
    EXPECT_EQ(rows.rows(0, 0).solid, ldi.solid);
}

TEST(Solid, StaysWithItsSampleWhenSorted) {
    const Ldi shuffled = ldi_of({{{.z = 4}, {.z = 3}}, {{.z = 2, .colour = 0, .alpha = 0}, {.z = 5}}});
    EXPECT_EQ(tidy(solid(shuffled, {.4f, .3f, .2f, .5f})).solid, (Floats{.3f, .4f, .5f}));
    EXPECT_EQ(tidy(solid(ldi_of({{{.z = 4}, {.z = 4}}}), {.4f, .3f})).solid, Floats{.3f});
}

TEST(Solid, OfOtherPicturesIsNotKnown) {
    const Ldi known = solid(ldi_of({{{.z = 2}}}), {.7f}), other = ldi_of({{{.z = 3}}});
    EXPECT_EQ(deep_merge({known, other}).solid, (Floats{.7f, 0}));
    EXPECT_TRUE(deep_merge({other, other}).solid.empty());
    EXPECT_FALSE(same_samples(known, ldi_of({{{.z = 2}}})));
}

TEST(Solid, IsTheLeastOfWhatIsMerged) {
    EXPECT_EQ(clustered(solid(ldi_of({{{.z = 2}, {.z = 3}}}), {.4f, .3f})).solid,
              Floats{.4f}); // of the front
    EXPECT_EQ(clustered(solid(ldi_of({{{.z = 2, .alpha = .6f}, {.z = 3}}}), {.4f, .3f})).solid, Floats{.3f});
    EXPECT_EQ(clustered(solid(ldi_of({{{.z = 2, .alpha = .2f}, {.z = 3}}}), {0, .3f})).solid, Floats{.3f});
    const Ldi four = ldi_of({{{.z = 2}}, {{.z = 2}}, {{.z = 2}}, {{.z = 2}}});
    EXPECT_EQ(proxy(solid(four, {.4f, .3f, .2f, 0}), 2).solid, (Floats{.3f, 0}));
}

TEST(Solid, IsTheMostOfWhatIsOneInACellOfALens) {
    const Ldi four = ldi_of({{{.z = 2}}, {{.z = 2}}, {{.z = 2}}, {{.z = 2}}});
    EXPECT_EQ(proxy(solid(four, {.4f, .3f, .2f, 0}), 2, {.scale = 1, .tolerance = .25}).solid,
              (Floats{.4f, .2f}));
}

TEST(Solid, OfLayersThatBecomeOneIsTheLeastToo) {
    const Ldi layers = ldi_of({{{.z = 2, .alpha = .5f}, {.z = 2.001f}}, {{.z = 2, .alpha = .4f}}});
    EXPECT_EQ(merge_layers(solid(layers, {.2f, .3f, 0}), 1, .25).solid, (Floats{.2f, 0}));
}

TEST(Solid, IsAFiniteNumberFromZeroOn) {
    constexpr float inf = std::numeric_limits<float>::infinity(),
                    nan = std::numeric_limits<float>::quiet_NaN();
    Ldi ldi = solid(ldi_of({{{.z = 1}, {.z = 2}, {.z = 3}, {.z = 4}}}), {.5f, -1, nan, inf});
    EXPECT_EQ(sanitize(ldi, "ldi").places, 3u);
    EXPECT_EQ(ldi.solid, (Floats{.5f, 0, 0, 0}));
}

} // namespace
} // namespace sparselens
