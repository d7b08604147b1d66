#include "lab/trace/scenes.h"

#include "base/error.h"
#include "lab/trace/fair.h"
#include "lab/trace/macro.h"
#include "lab/trace/materials.h"
#include "lab/trace/planes.h"
#include "lab/trace/scene_parts.h"

#include <fmt/format.h>

#include <array>

namespace sparselens::lab {

namespace {

Scene fence() {
    Scene scene = floor_and_wall();
    scene.spheres = {{{0, -0.3, 5}, 0.7, dots},
                     {{1.6, -0.2, 8}, 0.8, stripes},
                     {{-1.7, -0.4, 3.4}, 0.6, stripes},
                     {{-2.8, 0.4, 11}, 1.4, dots}};
    add_fence(scene);
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

Scene planes() { return planes_scene(default_camera(0.06, 5)); }

// One plane, in focus across the middle of the picture, from a few lens radii before the camera to the horizon.
Scene slant() {
    Scene scene;
    scene.sky = {0.3f, 0.4f, 0.6f};
    scene.camera = default_camera(0.06, 5);
    const auto corner = [](double x, double z) { return Imath::V3d(x, 0.2 * (z - 5), z); };
    scene.quads.push_back({{{corner(-30, 1), corner(30, 1), corner(30, 50), corner(-30, 50)}}, even_tiles});
    return scene;
}

// Square lamps that face the camera, 2 x 2 pixels of the default picture on whole pixels, at depths where R F / z is
// whole too. There the centre view and the rim views at 0, 90, 180 and 270 degrees hold each lamp's energy exactly, and
// any error is the gather's.
Scene lamps() {
    Scene scene;
    scene.camera = default_camera(0.12, 5);
    scene.quads.push_back(facing(64, -2, -2, 2, 2, night));
    constexpr std::array<double, 6> depths = {1.6, 2.4, 3.2, 9.6, 19.2, 38.4};
    constexpr double pixel = 1.0 / 640;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 6; ++column) {
            const double left = pixel * (64 + 102 * column - 320), bottom = pixel * (108 - 108 * row);
            scene.quads.push_back(facing(depths[std::size_t(column + 2 * row) % 6], left, bottom,
                                         left + 2 * pixel, bottom + 2 * pixel, bright_lamp));
        }
    return scene;
}

// Sheets of partial coverage before an opaque backdrop, and two banks of mist that overlap each other and them.
Scene mist() {
    Scene scene;
    scene.translucent = true;
    scene.camera = default_camera(0.06, 5);
    scene.quads = {facing(3, -2, -2, 0.15, 2, near_sheet), facing(5, -0.2, -2, 2, 0.12, focus_sheet),
                   facing(8, -2, -0.15, 2, 2, far_sheet), facing(14, -3, -3, 3, 3, backdrop)};
    scene.slabs = {{2, 7, 0.12, {0.55f, 0.6f, 0.7f}}, {4, 11, 0.08, {0.7f, 0.5f, 0.35f}}};
    return scene;
}

// Chrome balls and an upright mirror among the spheres of "fence", in and out of focus. Their reflections depend on the
// camera's position, and the sharpness on the total length of the light's path.
Scene mirror() {
    Scene scene = floor_and_wall();
    scene.mirrors = true;
    scene.spheres = {{{0, -0.3, 5}, 0.7, chrome},       {{1.6, -0.2, 8}, 0.8, stripes},
                     {{-1.7, -0.4, 3.4}, 0.6, chrome},  {{-2.8, 0.4, 11}, 1.4, dots},
                     {{1.05, -0.7, 3.6}, 0.3, stripes}, {{-0.9, -0.75, 4.2}, 0.25, dots},
                     {{1, -0.75, 5.6}, 0.25, chrome}};
    scene.quads.push_back({{{{2.1, -1, 4.6}, {3.4, -1, 7}, {3.4, 1.4, 7}, {2.1, 1.4, 4.6}}}, chrome});
    return scene;
}

// A room for mirrors and glass: walls and a floor behind the camera too, and a lens so wide that reflections move by
// several pixels.
Scene room() {
    Scene scene;
    scene.mirrors = true;
    scene.sky = {0.3f, 0.4f, 0.6f};
    scene.camera = default_camera(0.12, 8);
    scene.quads = {{{{{-9, -1, -7}, {9, -1, -7}, {9, -1, 16}, {-9, -1, 16}}}, mosaic},
                   {{{{-12, -1, 16}, {12, -1, 16}, {12, 9, 16}, {-12, 9, 16}}}, mosaic},
                   {{{{-12, -1, -6}, {12, -1, -6}, {12, 9, -6}, {-12, 9, -6}}}, mosaic}};
    return scene;
}

// The image of a point is its reflection in the plane: planar depth 8 - z.
Scene plane_mirror_of(Material material) {
    Scene scene = room();
    scene.quads.push_back(facing(4, -0.4, -0.2, 0.35, 0.22, material));
    scene.spheres = {{{1.9, -0.5, 4.5}, 0.5, dots}};
    return scene;
}
Scene plane_mirror() { return plane_mirror_of(silver); }
Scene brushed_mirror() { return plane_mirror_of(brushed); }

// The image of a point behind the glass is nearer than the point by glass_thickness (1 - 1 / refractive_index), for
// rays perpendicular to the glass.
Scene glass_slab() {
    Scene scene = room();
    scene.quads.push_back(facing(3, -0.35, -0.14, 0.3, 0.2, clear_glass));
    scene.quads.push_back(facing(9, -0.7, -0.11, 0.7, 0.6, mosaic));
    scene.spheres = {{{0.7, -0.5, 7}, 0.5, dots}};
    return scene;
}

// A convex ball before a concave wall: a sphere around the scene and the camera. The wall shows points nearer than half
// its radius behind it, and farther points behind the camera.
Scene curved_mirrors() {
    Scene scene = room();
    scene.quads.resize(1);
    scene.spheres = {{{0, 0, -4}, 16, silver},
                     {{-0.8, 0, 4.5}, 0.9, silver},
                     {{1.2, -0.4, 4}, 0.6, dots},
                     {{2.6, -0.1, 9}, 0.9, dots},
                     {{-3, -0.2, 7}, 0.8, stripes}};
    return scene;
}

Scene glossy_floor() {
    Scene scene = room();
    scene.quads[0].material = glossy_tiles;
    scene.spheres = {{{-1, -0.2, 5}, 0.8, dots}, {{1.2, -0.4, 4}, 0.6, stripes}, {{2, 0, 9}, 1, mosaic}};
    return scene;
}

// Objects at five depths, some in front of others, and nothing behind them: an element for a compositor.
Scene element() {
    Scene scene;
    scene.sky_coverage = 0;
    scene.camera = default_camera(0.06, 5);
    scene.spheres = {{{0, -0.1, 5}, 0.7, dots},
                     {{1.3, 0.1, 8}, 0.8, stripes},
                     {{-1.1, -0.2, 3.4}, 0.5, stripes},
                     {{-1.8, 0.6, 11}, 1.2, dots}};
    for (int i = 0; i < 5; ++i) {
        const double x = -0.5 + 0.25 * i, w = 0.03, z = 2.4;
        scene.quads.push_back({{{{x, -0.4, z}, {x + w, -0.4, z}, {x + w, 0.4, z}, {x, 0.4, z}}}, dark});
    }
    return scene;
}

// Objects among and behind those of "element": the plate for it.
Scene plate() {
    Scene scene = floor_and_wall();
    scene.spheres = {{{0.9, -0.5, 3.6}, 0.45, dots}, {{-0.55, -0.35, 6.5}, 0.6, stripes}};
    return scene;
}

Scene element_in_plate() {
    Scene scene = plate();
    const Scene added = element();
    scene.spheres.insert(scene.spheres.end(), added.spheres.begin(), added.spheres.end());
    scene.quads.insert(scene.quads.end(), added.quads.begin(), added.quads.end());
    return scene;
}

constexpr SceneEntry scenes[] = {
    {"fence", "spheres and small bright lamps behind a thin dark fence", fence},
    {"grass", "spheres among 200 thin slanted blades", grass},
    {"planes", "textured planes that face the camera, in front of, in and behind focus; in closed form",
     planes},
    {"slant", "one plane at a grazing angle, through the plane of focus", slant},
    {"lamps", "tiny lamps of radiance 1000 far out of focus before a dark wall", lamps},
    {"mirror", "chrome balls and a mirror: surfaces whose colour depends on the direction", mirror},
    {"plane-mirror", "a plane mirror that faces the camera and a room behind it; depths in closed form",
     plane_mirror},
    {"brushed-mirror", "the same mirror, rough", brushed_mirror},
    {"glass-slab", "a room through thick glass; depths in closed form", glass_slab},
    {"curved-mirrors", "a convex ball before a concave wall", curved_mirrors},
    {"glossy-floor", "balls on a varnished floor: what it reflects lies over what it is", glossy_floor},
    {"element", "spheres and bars at five depths before nothing: alpha 0 beside them", element},
    {"plate", "a room with two balls that stand among the objects of element", plate},
    {"element-in-plate", "both in one", element_in_plate},
    {"fair", "a wheel that turns, a ball behind the fence and lamps that move, from a camera that pans",
     fair_scene},
    {"mist", "sheets of partial coverage and overlapping volumes before a textured wall", mist},
    {"macro", "a head of steep relief, 85 mm and f/1 away, lamps of radiance 200 behind it", macro_scene},
    {"scales", "a cone of overlapping scales, 85 mm and f/1 away, lamps of radiance 200 behind it",
     scales_scene},
};

} // namespace

std::span<const SceneEntry> scene_table() { return scenes; }

Scene build_scene(std::string_view name) {
    for (const SceneEntry &entry : scenes)
        if (name == entry.name) return entry.build();
    throw Error(fmt::format("no scene is called '{}'", name));
}

Scene seen_after(Scene scene, double dolly) {
    for (Slab &slab : scene.slabs) {
        slab.z_front -= dolly;
        slab.z_back -= dolly;
    }
    return scene;
}

} // namespace sparselens::lab
