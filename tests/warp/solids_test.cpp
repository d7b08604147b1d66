// Solids found from views: planes with gaps that a view saw through, or that none did.
#include "dof/lens/lens_gather.h"
#include "lens/lens_samples.h"
#include "support/views.h"
#include "warp/warp.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

constexpr double scale = 12; // R F
constexpr WarpOptions options{.focal_px = 100, .radius = scale / 100};
const Windows windows = windows_of_size(96, 96);

// A plate; a board that begins `gap` pixels beyond the plate's edge and continues behind it; and a bright wall. Edges
// are diagonal; positions are the centre's.
struct Plates {
    double plate = 40, board = 36.8, wall = 10; // disparities
    double gap = -20, width = 24;               // of the board; pixels across both edges

    // The disparity that lens point u sees at a pixel.
    double seen(const Imath::V2d &pixel, const Imath::V2d &u) const {
        const auto across = [&](double depth) { // distance from the plate's edge, to the lower right
            const Imath::V2d at = pixel + depth * Imath::V2d(u.x, -u.y);
            return (at.x + at.y - 80) / std::sqrt(2.0);
        };
        if (across(plate) < 0) return plate;
        return across(board) > gap && across(board) < width ? board : wall;
    }
    View view(const Imath::V2d &u) const {
        return make_view(windows, options.radius * u, [&](int x, int y) {
            const double depth = seen({x + 0.5, y + 0.5}, u);
            return ViewPixel{
                .z = float(scale / depth), .r = 0.2f, .g = depth == wall ? 1.0f : 0.0f, .b = 0.2f};
        });
    }
    Ldi ldi() const {
        Progress silent;
        return warp(five_views([&](const Imath::V2d &u) { return view(u); }), options, silent);
    }
};

ThinLens lens_on(double depth) {
    return {.radius = options.radius, .focal_px = options.focal_px, .focus = scale / depth};
}

// The total green light in pixels less than 6 pixels from the plate's edge.
double green_along_the_edge(const Plates &plates, const Ldi &ldi) {
    Progress silent;
    const Image image = lens_gather(ldi, lens_on(plates.plate), windows.data, {.lens_samples = 256}, silent);
    double sum = 0;
    for (int y = 20; y < 76; ++y)
        for (int x = 20; x < 76; ++x)
            if (std::abs(x + y + 1 - 80) < 6) sum += double(image.at(1, x, y));
    return sum;
}
double true_green_along_the_edge(const Plates &plates) {
    double sum = 0, weights = 0;
    const auto points = lens_samples(Aperture(ApertureShape()), 256, 1);
    for (const LensSample &p : points) weights += double(p.weight);
    for (int y = 20; y < 76; ++y)
        for (int x = 20; x < 76; ++x)
            for (const LensSample &p : points) {
                // With the plate in focus, a lens point at u sees a point of depth w at p + (w - plate) u.
                const Imath::V2d u(double(p.x), -double(p.y));
                const Imath::V2d pixel(x + 0.5 - plates.plate * u.x, y + 0.5 + plates.plate * u.y);
                if (std::abs(x + y + 1 - 80) < 6 && plates.seen(pixel, u) == plates.wall)
                    sum += double(p.weight) / weights;
            }
    return sum;
}

// The board continues 20 pixels behind the plate, but no view sees more than 2.3 of these. Along the diagonal the lens
// looks 3.2 pixels behind the plate's edge, where views beside it saw the wall. Fillers, which come first where a lens
// point meets nothing, may continue the wall.
TEST(Solids, NoLightComesThroughAGapThatNoViewSaw) {
    const Plates plates;
    Ldi ldi = plates.ldi();
    ASSERT_FALSE(ldi.solid.empty());
    EXPECT_EQ(true_green_along_the_edge(plates), 0);
    const double solid = green_along_the_edge(plates, ldi);
    ldi.solid.clear();
    const double open = green_along_the_edge(plates, ldi);
    EXPECT_GT(open,
              0.5); // half the light of a wall pixel; the rest is closed as cracks of the board
    EXPECT_LT(solid, 0.1 * open);
}

// Where the board begins some pixels beyond the edge, the views and the lens see the wall through the gap.
TEST(Solids, NothingOfAGapThatViewsSawIsLost) {
    Plates plates;
    for (const double gap : {3.0, 6.0}) {
        plates.gap = gap;
        Ldi ldi = plates.ldi();
        const double solid = green_along_the_edge(plates, ldi), seen = true_green_along_the_edge(plates);
        ldi.solid.clear();
        EXPECT_GE(solid, 0.99 * green_along_the_edge(plates, ldi)) << gap;
        EXPECT_NEAR(solid, seen, 0.02 * seen) << gap;
    }
}

} // namespace
} // namespace sparselens
