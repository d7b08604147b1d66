// Traced lamps behind thin posts, with focus and aperture pulls: each lamp's light is the share of the lens that sees
// it.
#include "dof/gather_picture.h"
#include "lab/tests/support/traced.h"
#include "lens/lens_points.h"
#include "lens/thin_lens.h"
#include "warp/warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sparselens {
namespace {

using namespace lab;

constexpr int width = 320, height = 180, frames = 8;
constexpr double full = 0.12, focus = 5; // scene units: the radius of the views' lens
constexpr double posts_px = 16;          // disparity
constexpr int first_post = -150, post_step = 23;

// The share of the unit disc on the left of a line.
double left_of(double x) {
    x = std::clamp(x, -1.0, 1.0);
    return 0.5 + (x * std::sqrt(1 - x * x) + std::asin(x)) / std::numbers::pi;
}

// A lamp one pixel wide and high in all five views, because its position and disparity are whole numbers.
struct Lamp {
    Imath::V2i pixel; // from the middle of the picture
    int near_px;

    double z() const { return full * width / near_px; }
    // The share of a lens that posts of that width leave open. A point of the lamp at x is seen through lens point u at
    // x + (near - posts) u radius / full, in the plane of the posts.
    double seen(double radius, int post) const {
        const double scale = (posts_px - near_px) * radius / full;
        double hidden = 0;
        constexpr int parts = 16; // of a lamp
        for (int part = 0; part < parts; ++part)
            for (int i = 0; i < 14; ++i) {
                const double left =
                    first_post + post_step * i - (pixel.x + (part + 0.5) / parts); // of the lens's middle
                hidden += left_of((left + post) / scale) - left_of(left / scale);
            }
        return 1 - hidden / parts;
    }
};

std::vector<Lamp> all_lamps() {
    std::vector<Lamp> lamps;
    for (int i = 0; i < 15; ++i)
        lamps.push_back({{-118 + i % 5 * 57 + 7 * (i / 5), -58 + i / 5 * 56 + 3 * (i % 4)}, 1 << i % 3});
    return lamps;
}

Paint black(const Imath::V3d &) { return {.colour = {0, 0, 0}, .emits = true}; }
Paint white(const Imath::V3d &) { return {.colour = {60, 60, 60}, .emits = true}; }

// A square that covers these pixels of the centre view, y up.
Quad facing(double z, double left, double bottom, double right, double top, Material material) {
    const auto corner = [&](double x, double y) { return Imath::V3d(x, y, width) * (z / width); };
    return {{{corner(left, bottom), corner(right, bottom), corner(right, top), corner(left, top)}}, material};
}

Ldi ldi_of(const std::vector<Lamp> &lamps, int post) {
    Scene scene;
    scene.quads.push_back(facing(40, -400, -400, 400, 400, black));
    for (int i = 0; i < 14; ++i) {
        const int left = first_post + post_step * i;
        scene.quads.push_back(facing(full * width / posts_px, left, -400, left + post, 400, black));
    }
    for (const Lamp &lamp : lamps) {
        const auto x = double(lamp.pixel.x), y = double(lamp.pixel.y);
        scene.quads.push_back(facing(lamp.z(), x, y, x + 1, y + 1, white));
    }
    const SceneCamera camera(scene, {full, width, focus}, width, height);
    Progress silent;
    return warp(camera.five_views(16), {.focal_px = width, .radius = full, .focus = focus}, silent);
}

// The light of each lamp: the sum over the pixels nearer to it than to the other lamps.
std::vector<double> light_of(const Image &picture, const std::vector<Lamp> &lamps) {
    std::vector<double> light(lamps.size(), 0);
    for (std::size_t i = 0; i < picture.windows.pixels(); ++i) {
        const Imath::V2i at = picture.windows.pixel(i);
        const auto distance = [&](const Lamp &lamp) {
            return (at - Imath::V2i(width / 2 + lamp.pixel.x, height / 2 - 1 - lamp.pixel.y)).length2();
        };
        light[std::size_t(std::ranges::min_element(lamps, {}, distance) - lamps.begin())] +=
            double(picture.plane(0)[i]);
    }
    return light;
}

TEST(LampsBehindPosts, GiveTheLightOfTheLensThatSeesThem) {
    const std::vector<Lamp> lamps = all_lamps();
    const Imath::Box2i frame({0, 0}, {width - 1, height - 1});
    for (const int post : {2, 4}) {
        const Ldi ldi = ldi_of(lamps, post);
        for (int frame_number = 0; frame_number < 2 * frames; ++frame_number) {
            const double along = double(frame_number % frames) / (frames - 1);
            const bool pulls_focus = frame_number < frames;
            const ThinLens lens{.radius = pulls_focus ? full : full * (0.5 + 0.5 * along),
                                .focal_px = width,
                                .focus = pulls_focus ? 4 + 2 * along : focus};
            Progress silent;
            const Image picture = gather_picture(ldi, lens, frame, frame, {}, silent);
            const std::vector<double> light = light_of(picture, lamps);
            for (std::size_t i = 0; i < lamps.size(); ++i)
                EXPECT_NEAR(light[i] / 60, lamps[i].seen(lens.radius, post), 0.01)
                    << "lamp " << i << ", posts of " << post << " pixels, "
                    << (pulls_focus ? "focus " : "aperture ") << frame_number % frames;
        }
    }
}

} // namespace
} // namespace sparselens
