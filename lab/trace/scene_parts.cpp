#include "lab/trace/scene_parts.h"

#include "lab/trace/materials.h"
#include "lens/thin_lens.h"

namespace sparselens::lab {

Camera default_camera(double lens_radius, double focus_distance) {
    Camera camera;
    camera.focal_length_mm = 36;
    camera.sensor_width_mm = 36;
    camera.fstop = fstop_of(lens_radius, *camera.focal_length_mm);
    camera.focus_distance = focus_distance;
    camera.metres_per_unit = 1;
    return camera;
}

Scene floor_and_wall() {
    Scene scene;
    scene.sky = {0.3f, 0.4f, 0.6f};
    scene.camera = default_camera(0.06, 5);
    scene.quads.push_back({{{{-12, -1, 1}, {12, -1, 1}, {12, -1, 30}, {-12, -1, 30}}}, floor_tiles});
    scene.quads.push_back({{{{-15, -1, 18}, {15, -1, 18}, {15, 10, 18}, {-15, 10, 18}}}, wall_tiles});
    return scene;
}

void add_fence(Scene &scene) {
    for (int i = 0; i < 14; ++i) {
        const double x = -1.1 + 0.16 * i, w = 0.02, z = 2.2;
        scene.quads.push_back({{{{x, -1, z}, {x + w, -1, z}, {x + w, 1, z}, {x, 1, z}}}, dark});
    }
}

Quad facing(double z, double left, double bottom, double right, double top, Material material) {
    const double x0 = z * left, x1 = z * right, y0 = z * bottom, y1 = z * top;
    return {{{{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}}}, material};
}

} // namespace sparselens::lab
