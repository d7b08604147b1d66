#include "trace/scenes.h"

#include "trace/materials.h"

namespace sparselens {

namespace {

// 36 mm lens on a 36 mm film back: the picture spans x / z from -1/2 to 1/2.
Camera default_camera(double lens_radius, double focus_distance) {
    Camera camera;
    camera.focal_length_mm = 36;
    camera.sensor_width_mm = 36;
    camera.fstop = 0.036 / (2 * lens_radius);
    camera.focus_distance = focus_distance;
    camera.metres_per_unit = 1;
    return camera;
}

// The stage that fence and grass share.
Scene floor_and_wall() {
    Scene scene;
    scene.sky = {0.3f, 0.4f, 0.6f};
    scene.camera = default_camera(0.06, 5);
    scene.quads.push_back({{{{-12, -1, 1}, {12, -1, 1}, {12, -1, 30}, {-12, -1, 30}}}, floor_tiles});
    scene.quads.push_back({{{{-15, -1, 18}, {15, -1, 18}, {15, 10, 18}, {-15, 10, 18}}}, wall_tiles});
    return scene;
}

Scene fence() {
    Scene scene = floor_and_wall();
    scene.spheres = {{{0, -0.3, 5}, 0.7, dots},
                     {{1.6, -0.2, 8}, 0.8, stripes},
                     {{-1.7, -0.4, 3.4}, 0.6, stripes},
                     {{-2.8, 0.4, 11}, 1.4, dots}};
    for (int i = 0; i < 14; ++i) {
        const double x = -1.1 + 0.16 * i, w = 0.02, z = 2.2;
        scene.quads.push_back({{{{x, -1, z}, {x + w, -1, z}, {x + w, 1, z}, {x, 1, z}}}, dark});
    }
    for (int i = 0; i < 40; ++i)
        scene.spheres.push_back({{-8 + 16 * hash(i, 1, 2), 3 * hash(i, 3, 4), 17}, 0.04, lamp});
    return scene;
}

Scene grass() {
    Scene scene = floor_and_wall();
    for (int i = 0; i < 60; ++i) {
        const Imath::V3d centre(-4 + 8 * hash(i, 5, 1), -1 + 2.5 * hash(i, 6, 1), 2 + 10 * hash(i, 7, 1));
        scene.spheres.push_back({centre, 0.08 + 0.25 * hash(i, 8, 1), i % 2 == 0 ? dots : stripes});
    }
    for (int i = 0; i < 200; ++i) {
        const double x = -3 + 6 * hash(i, 9, 1), z = 1.8 + 8 * hash(i, 10, 1);
        const double w = 0.01 + 0.01 * hash(i, 2, 2), t = 0.4 * (hash(i, 4, 4) - 0.5);
        scene.quads.push_back({{{{x, -1, z}, {x + w, -1, z}, {x + w + t, 1, z}, {x + t, 1, z}}}, stripes});
    }
    return scene;
}

constexpr SceneEntry scenes[] = {
    {"fence", "spheres and small bright lamps behind a thin dark fence", fence},
    {"grass", "spheres among 200 thin slanted blades", grass},
};

} // namespace

std::span<const SceneEntry> scene_table() { return scenes; }

} // namespace sparselens
