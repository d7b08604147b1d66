#include "base/subpixels.h"
#include "lab/reference/subpixels_slowly.h"
#include "support/all_channels.h"

#include <gtest/gtest.h>

#include <bit>

namespace sparselens {
namespace {

using Shape = PixelFilter::Shape;

// Includes data windows that begin or end within a block, inside the display window or beyond it.
TEST(Subpixels, AreAsTheReferenceHasThem) {
    for (const int across : {1, 2, 3, 4})
        for (const PixelFilter &filter :
             {PixelFilter{}, PixelFilter{Shape::blackman_harris, 1.5}, PixelFilter{Shape::gaussian, 3}}) {
            const Imath::Box2i display({0, 0}, {12 * across - 1, 9 * across - 1});
            for (const Imath::Box2i &data :
                 {display, Imath::Box2i({-7, -3}, {11 * across, 10 * across + 1}),
                  Imath::Box2i({3 * across + 1, -3}, {6 * across, 5 * across + 1})}) {
                const Image fine = random_picture(windows_of(display, data));
                const Imath::Box2i box({2, 1}, {8, 7});
                const Subpixels by{across, filter};
                const Image fast = mean_of_subpixels(fine, by, box),
                            slow = mean_of_subpixels_slowly(fine, by, box);
                ASSERT_EQ(fast.windows, slow.windows);
                for (std::size_t i = 0; i < fast.values.size(); ++i) {
                    const Channel &channel = fast.channels[i / fast.windows.pixels()];
                    if (is_light(channel) || channel.kind == ChannelKind::matte_coverage)
                        ASSERT_NEAR(fast.values[i], slow.values[i], 1e-6) << channel.name;
                    else
                        ASSERT_EQ(std::bit_cast<std::uint32_t>(fast.values[i]),
                                  std::bit_cast<std::uint32_t>(slow.values[i]))
                            << channel.name;
                }
            }
        }
}

} // namespace
} // namespace sparselens
