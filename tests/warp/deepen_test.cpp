#include "base/error.h"
#include "support/ldi_samples.h"
#include "support/scratch_folder.h"
#include "support/views.h"
#include "warp/deepen.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

TEST(Deepen, PixelsThatShowSomethingAreSamples) {
    const View view = random_view({Imath::Box2i({0, 0}, {9, 9}), Imath::Box2i({-3, 2}, {12, 20})}, {1, 2}, 3);
    const Ldi ldi = deepen(view, view.image.channels);
    EXPECT_EQ(ldi.windows, view.image.windows);
    EXPECT_EQ(ldi.weight, std::vector<float>(ldi.samples(), 1));
    EXPECT_TRUE(ldi.dx.empty() && ldi.dy.empty() && ldi.z_back.empty());
    ASSERT_EQ(ldi.begin.size(), view.z.size() + 1);
    for (std::size_t pixel = 0; pixel < view.z.size(); ++pixel) {
        ASSERT_EQ(ldi.pixel(pixel).size(), view.image.plane(3)[pixel] == 0 ? 0u : 1u);
        if (ldi.pixel(pixel).empty()) continue;
        const std::uint64_t i = ldi.pixel(pixel).front();
        EXPECT_EQ(ldi.z[i], view.z[pixel]);
        for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(ldi.values[k][i], view.image.plane(k)[pixel]);
    }
}

TEST(Deepen, ChannelsComeInTheOrderAskedFor) {
    const View view = random_view(windows_of_size(2, 2), {0, 0}, 1);
    const Ldi ldi = deepen(view, std::vector<Channel>{{"A"}, {"G"}});
    ASSERT_EQ(ldi.values.size(), 2u);
    EXPECT_EQ(ldi.alpha(), 0u);
    EXPECT_EQ(ldi.values[1][0], view.image.plane(1)[ldi.begin[1] == 1 ? 0 : 1]);
    EXPECT_EQ(what_of<Error>([&] { deepen(view, std::vector<Channel>{{"albedo.R"}}); }),
              "view: has no channel albedo.R, which the centre view has");
}

TEST(Deepen, WithoutAlphaEverythingIsVisible) {
    View view = random_view(windows_of_size(8, 8), {0, 0}, 1);
    view.image = Image(view.image.windows, {{"Y"}});
    EXPECT_EQ(deepen(view, view.image.channels).samples(), 64u);
}

} // namespace
} // namespace sparselens
