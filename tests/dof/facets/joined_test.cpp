#include "dof/facets/facets.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <functional>

namespace sparselens {
namespace {

constexpr int across = 8;
constexpr float apart = 4;
const ThinLens lens{.radius = 0.625, .focal_px = 640, .focus = 5};

// An opaque sample in each pixel from column 8 of EXR coordinates on. `depth`: disparity, pixels.
Ldi surface(const std::function<double(int x)> &depth, bool shows_images = false) {
    Windows windows = windows_of_size(4 * across, across);
    windows.data = Imath::Box2i({across, 0}, {3 * across - 1, across - 1});
    return make_ldi(windows, {{"Y"}, {"A"}}, [&](int x, int) {
        Sample s{lens.radius * lens.focal_px / depth(x), {1, 1}};
        if (shows_images) s.image_z = 2 * s.z;
        return std::vector<Sample>{s};
    });
}

// The number of samples that are the first of their surfaces.
std::size_t surfaces_in(const Ldi &ldi) {
    const auto joined = joined_in_cells(ldi, Links(ldi, lens), across, apart);
    std::size_t first = 0;
    for (std::uint32_t i = 0; i < joined.size(); ++i) {
        EXPECT_LE(joined[i], i);
        EXPECT_EQ(joined[joined[i]], joined[i]);
        first += joined[i] == i;
    }
    return first;
}

TEST(JoinedInCells, ASteepSurfaceIsOneInEachCell) {
    EXPECT_EQ(surfaces_in(surface([](int x) { return 20 + 1.5 * x; })), 2u);
}

TEST(JoinedInCells, ThatStaysAloneWhichIsFlatOrShowsAnImage) {
    const std::size_t all = 2 * across * across;
    EXPECT_EQ(surfaces_in(surface([](int x) { return 20 + 0.1 * x; })), all);
    EXPECT_EQ(surfaces_in(surface([](int x) { return 20 + 1.5 * x; }, true)), all);
}

// The first cell contains half of the surface; the flat wall is behind its other half.
TEST(JoinedInCells, ASilhouetteIsNot) {
    EXPECT_EQ(surfaces_in(surface([](int x) { return x < across + 4 ? 60 + 1.5 * x : 20; })),
              2u + across * across);
}

} // namespace
} // namespace sparselens
