#include "lab/trace/macro.h"

#include "lab/trace/materials.h"
#include "lens/thin_lens.h"

#include <cmath>
#include <numbers>

namespace sparselens::lab {

namespace {

Camera macro_camera() {
    Camera camera;
    camera.focal_length_mm = 85;
    camera.sensor_width_mm = 36;
    camera.fstop = 1;
    camera.focus_distance = 0.45;
    camera.metres_per_unit = 1;
    return camera;
}

// Bumps on the head, spread evenly by the golden angle over the half that faces the camera. At most half of each stands
// out.
void add_bumps(Scene &scene, const Sphere &head, int count) {
    const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
    for (int i = 0; i < count; ++i) {
        const double across = std::sqrt((i + 0.5) / count), along = std::sqrt(1 - across * across);
        const double angle = golden * i, radius = 0.006 + 0.006 * hash(i, 1, 5);
        const Imath::V3d outwards(across * std::cos(angle), across * std::sin(angle), -along);
        scene.spheres.push_back({head.centre + head.radius * outwards, radius, skin});
    }
}

// A blunt cone between two spheres with its axis towards the middle of the lens. Its side is steep, and the middle of
// the lens sees all of it if `base` looks wider than `tip` from there.
void add_horn(Scene &scene, const Imath::V2d &slope, double tip_z, double tip, double base_z, double base) {
    constexpr int count = 60;
    for (int i = 0; i <= count; ++i) {
        const double t = double(i) / count, z = tip_z + t * (base_z - tip_z);
        scene.spheres.push_back({z * Imath::V3d(slope.x, slope.y, 1), tip + t * (base - tip), skin});
    }
}

// Trapezia around an upright axis, in a spiral by the golden angle. Each leans outwards over those above it.
void add_scales(Scene &scene, const Imath::V3d &middle, double half_height, double widest, int count) {
    const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
    for (int i = 0; i < count; ++i) {
        const double up = 2 * (i + 0.5) / count - 1, angle = golden * i;
        const Imath::V3d outwards(std::cos(angle), 0, std::sin(angle)),
            along(-std::sin(angle), 0, std::cos(angle));
        const Imath::V3d base = middle + Imath::V3d(0, half_height * up, 0) +
                                widest * (std::sqrt(1 - 0.8 * up * up) - 0.3) * outwards;
        const Imath::V3d tip = base + 0.55 * widest * (0.75 * outwards + Imath::V3d(0, 0.65, 0));
        const double half_base = 0.3 * widest, half_tip = 0.15 * widest;
        scene.quads.push_back({{{base - half_base * along, base + half_base * along, tip + half_tip * along,
                                 tip - half_tip * along}},
                               skin});
    }
}

// Lamps inside the picture, as seen from the middle of the lens.
void add_lamps(Scene &scene, int count) {
    for (int i = 0; i < count; ++i) {
        const double z = 4 + 3 * hash(i, 3, 6);
        const Imath::V3d ray(0.4 * (hash(i, 1, 6) - 0.5), 0.22 * (hash(i, 2, 6) - 0.5), 1);
        scene.spheres.push_back({z * ray, 0.006, head_lamp});
    }
}

} // namespace

Scene macro_scene() {
    Scene scene;
    scene.camera = macro_camera();
    const Sphere head{{0, 0, 0.4}, 0.065, skin};
    scene.spheres = {head};
    add_bumps(scene, head, 120);
    add_horn(scene, {0, -0.02}, 0.272, 0.012, 0.335, 0.026); // the nose
    for (const double x : {-0.11, -0.07, 0.07, 0.11})
        for (const double y : {-0.05, 0.05}) add_horn(scene, {x, y + 0.1 * x}, 0.305, 0.007, 0.36, 0.0115);
    add_lamps(scene, 24);
    scene.quads.push_back({{{{-8, -6, 10}, {8, -6, 10}, {8, 6, 10}, {-8, 6, 10}}}, night});
    return scene;
}

Scene scales_scene() {
    Scene scene;
    scene.camera = macro_camera();
    const Imath::V3d middle(0, 0, 0.47);
    for (int i = -6; i <= 6; ++i) { // the core
        const double up = i / 6.5;
        scene.spheres.push_back(
            {middle + Imath::V3d(0, 0.055 * up, 0), 0.045 * (std::sqrt(1 - 0.8 * up * up) - 0.25), skin});
    }
    add_scales(scene, middle, 0.06, 0.05, 110);
    add_lamps(scene, 60);
    scene.quads.push_back({{{{-8, -6, 10}, {8, -6, 10}, {8, 6, 10}, {-8, 6, 10}}}, night});
    return scene;
}

} // namespace sparselens::lab
