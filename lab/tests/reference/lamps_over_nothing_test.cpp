// Lamps over nothing whose edge pixels have the depth of the sky.
#include "base/numbers.h"
#include "deep/mixed_pixels.h"
#include "lab/methods/scatter.h"
#include "lens/lens_points.h"
#include "support/views.h"
#include "warp/warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();

// Lamps over nothing, seen through a lens: discs at a depth, with centre and radius in pixels of the centre view. Half
// of their edge pixels have the depth of the sky, as in Cycles with a transparent film.
struct Lamp {
    double x, y, radius, z;
};
const std::vector<Lamp> lamps{{24, 24, 3, 2}, {70, 24, 3.4, 12}, {30, 70, 9.3, 2.6}, {72, 66, 6, 7}};
const ThinLens lens{.radius = 0.1, .focal_px = 200, .focus = 4}; // CoC -5 to 3.3 px

double coverage_at(int x, int y, const Imath::V2d &position) {
    int inside = 0;
    for (int k = 0; k < 64; ++k)
        inside += std::ranges::any_of(lamps, [&](const Lamp &lamp) {
            return std::hypot(x + (k % 8 + 0.5) / 8 - lamp.x + lens.focal_px / lamp.z * position.x,
                              y + (k / 8 + 0.5) / 8 - lamp.y - lens.focal_px / lamp.z * position.y) <
                   lamp.radius;
        });
    return inside / 64.0;
}

View lamps_from(const Imath::V2d &position) {
    const std::uint32_t view =
        mix_bits(std::uint32_t(1000 * position.x + 500), std::uint32_t(1000 * position.y + 500));
    return make_view(windows_of_size(96, 96), position, [&](int x, int y) {
        const double a = coverage_at(x, y, position);
        const auto distance = [&](const Lamp &lamp) {
            return std::hypot(x + 0.5 - lamp.x + lens.focal_px / lamp.z * position.x,
                              y + 0.5 - lamp.y - lens.focal_px / lamp.z * position.y) -
                   lamp.radius;
        };
        const Lamp &own = *std::ranges::min_element(lamps, {}, distance);
        const bool hit = unit_interval(mix_bits(view, std::uint32_t(96 * y + x))) < a;
        const float alpha = float(a); // premultiplied
        return ViewPixel{.z = hit ? float(own.z) : inf, .r = 5 * alpha, .g = 3 * alpha, .a = alpha};
    });
}

// The mean of the pictures through all lens points.
Image truth() {
    Image sum(windows_of_size(96, 96), rgba_channels());
    const auto points = spiral_lens_points(200);
    for (const Imath::V2d &u : points)
        for (int y = 0; y < 96; ++y)
            for (int x = 0; x < 96; ++x) {
                int inside = 0; // of four points in the pixel
                for (int k = 0; k < 4; ++k)
                    inside += std::ranges::any_of(lamps, [&](const Lamp &lamp) {
                        const Imath::V2d at =
                            seen_through(lens, {lamp.x, lamp.y}, circle_of_confusion(lens, lamp.z), u);
                        return std::hypot(x + (k % 2 + 0.5) / 2 - at.x, y + (k / 2 + 0.5) / 2 - at.y) <
                               lamp.radius;
                    });
                sum.at(3, x, y) += float(inside) / 4 / float(points.size());
            }
    return sum;
}

TEST(EdgeDepths, LampsOverNothingKeepTheirWidth) {
    std::vector<View> views;
    for (const Imath::V2d &u : {Imath::V2d(0, 0), {1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
        views.push_back(lamps_from(lens.radius * u));
        repair_edge_depths(views.back());
    }
    Progress silent;
    const Ldi ldi = warp(views, {.focal_px = lens.focal_px, .radius = lens.radius}, silent);
    const Image picture = crop(scatter(ldi, lens, {}, silent), windows_of_size(96, 96).data), right = truth();
    double squares = 0;
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 96; ++x) {
            const double off = double(picture.at(3, x, y) - right.at(3, x, y));
            squares += off * off;
            EXPECT_NEAR(off, 0, 0.1) << x << "," << y;
            const bool empty = right.at(3, x, y) == 0;
            EXPECT_LT(picture.at(3, x, y), empty ? 0.01f : 1.001f) << x << "," << y; // no halo
        }
    EXPECT_LT(std::sqrt(squares / (96 * 96)), 0.004); // 0.008 with unsettled depths
}

} // namespace
} // namespace sparselens
