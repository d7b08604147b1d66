#include "lab/trace/fair.h"

#include "lab/trace/materials.h"
#include "lab/trace/scene_parts.h"

#include <cmath>
#include <numbers>

namespace sparselens::lab {

namespace {

const Imath::V3d hub(0.9, 0.35, 7);
constexpr double rim = 1.1;

// A part of the wheel, from one distance from the hub to another, at an angle; both ends have a width.
Quad part_at(double angle, double from, double to, double from_width, double to_width, Material material) {
    const Imath::V3d along(std::cos(angle), std::sin(angle), 0), across(-along.y, along.x, 0);
    const auto corner = [&](double r, double width) { return hub + r * along + width / 2 * across; };
    return {
        {{corner(from, -from_width), corner(to, -to_width), corner(to, to_width), corner(from, from_width)}},
        material};
}

MovingBody wheel() {
    MovingBody body;
    body.spheres = {{hub, 0.15, dark}};
    constexpr int spokes = 10, pieces = 40;
    constexpr double turn = 2 * std::numbers::pi;
    const double chord = 2 * std::tan(turn / pieces / 2); // of a piece of the rim, at distance 1
    for (int i = 0; i < spokes; ++i) {
        const double angle = turn * i / spokes;
        body.quads.push_back(part_at(angle, 0.14, 0.9 * rim, 0.08, 0.08, stripes));
        body.spheres.push_back({hub + rim * Imath::V3d(std::cos(angle), std::sin(angle), 0), 0.035, lamp});
    }
    for (int i = 0; i < pieces; ++i)
        body.quads.push_back(part_at(turn * i / pieces, 0.9 * rim, rim, 0.9 * rim * chord, rim * chord,
                                     i % 2 == 0 ? dots : dark));
    body.motion = {.turn = 0.3, .pivot = hub};
    return body;
}

MovingBody ball() {
    MovingBody body;
    body.spheres = {{{-0.55, -0.25, 3.2}, 0.35, dots}};
    body.motion.path = {{-0.09, -0.02, 0}, {0, 0, 0}, {0.09, -0.02, 0}};
    return body;
}

MovingBody train() {
    MovingBody body;
    for (int i = 0; i < 6; ++i) body.spheres.push_back({{-4.5 + 0.8 * i, 1.2, 11}, 0.04, lamp});
    body.motion.path = {{0.25, 0, 0}, {-0.25, 0, 0}};
    return body;
}

} // namespace

Scene fair_scene() {
    Scene scene = floor_and_wall();
    add_fence(scene);
    scene.spheres = {{{-1.1, -0.4, 5}, 0.6, stripes}, {{2.9, -0.2, 9}, 0.8, dots}};
    for (int i = 0; i < 20; ++i)
        scene.spheres.push_back({{-8 + 16 * hash(i, 1, 2), 3 * hash(i, 3, 4), 17}, 0.04, lamp});
    scene.bodies = {wheel(), ball(), train()};
    scene.camera_motion = {.turn = 0.02, .axis = {0, 1, 0}};
    return scene;
}

} // namespace sparselens::lab
