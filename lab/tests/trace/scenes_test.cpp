#include "lab/tests/trace/small_scenes.h"
#include "lab/trace/materials.h"
#include "lab/trace/planes.h"

#include <gtest/gtest.h>

#include <set>

namespace sparselens::lab {
namespace {

TEST(Scenes, NamesAreUniqueAndLensesComplete) {
    std::set<std::string> names;
    for (const SceneEntry &entry : scene_table()) {
        EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
        const Camera camera = entry.build().camera;
        EXPECT_TRUE(camera.focal_length_mm && camera.sensor_width_mm && camera.fstop && camera.focus_distance)
            << entry.name;
    }
    EXPECT_EQ(names, (std::set<std::string>{"brushed-mirror", "curved-mirrors", "element", "element-in-plate",
                                            "fair", "fence", "glass-slab", "glossy-floor", "grass", "lamps",
                                            "macro", "mirror", "mist", "plane-mirror", "planes", "plate",
                                            "scales", "slant"}));
}

// Quads are planar, with corners in order, and convex, as the tracer requires.
TEST(Scenes, QuadsAreSound) {
    for (const SceneEntry &entry : scene_table()) {
        Scene scene = entry.build();
        for (const MovingBody &body : scene.bodies)
            scene.quads.insert(scene.quads.end(), body.quads.begin(), body.quads.end());
        for (const Quad &quad : scene.quads) {
            const auto &c = quad.corners;
            const Imath::V3d normal = ((c[2] - c[0]) % (c[3] - c[1])).normalized();
            for (std::size_t i = 0; i < 4; ++i) {
                EXPECT_NEAR((c[i] - c[0]) ^ normal, 0, 1e-12) << entry.name;
                EXPECT_GT(((c[(i + 1) % 4] - c[i]) % (c[(i + 2) % 4] - c[(i + 1) % 4])) ^ normal, 0)
                    << entry.name;
            }
        }
    }
}

// At 320x180, where the focal length has 320 pixels.
TEST(Scenes, FairMovesByPixels) {
    const Scene scene = build_scene("fair");
    ASSERT_EQ(scene.bodies.size(), 3u);
    const auto moved = [](const MovingBody &body, const Imath::V3d &point) {
        const Imath::V3d from = Placement(body.motion, 0).point(point),
                         to = Placement(body.motion, 1).point(point);
        return 320 * (from / from.z - to / to.z).length();
    };
    for (const MovingBody &body : scene.bodies) {
        EXPECT_TRUE(body.motion.moves());
        const Imath::V3d point = body.spheres.back().centre;
        EXPECT_GT(moved(body, point), 14);
        EXPECT_LT(moved(body, point), 19);
    }
    EXPECT_NEAR(320 * std::tan(scene.camera_motion.turn), 6.4, 0.1);
}

TEST(Scenes, FenceIsAsWritten) {
    const Scene scene = build_scene("fence");
    ASSERT_EQ(scene.quads.size(), 2u + 14u);
    ASSERT_EQ(scene.spheres.size(), 4u + 40u);
    EXPECT_EQ(scene.spheres[1].centre, Imath::V3d(1.6, -0.2, 8));
    EXPECT_EQ(scene.spheres[1].radius, 0.8);
    EXPECT_EQ(scene.spheres[1].material, stripes);
    EXPECT_NEAR((scene.quads[2 + 13].corners[2] - Imath::V3d(1.0, 1, 2.2)).length(), 0, 1e-12);
    EXPECT_EQ(scene.quads[2].material, dark);
    EXPECT_EQ(scene.spheres[4].centre, Imath::V3d(-8 + 16 * 7756041 * 0x1p-24, 3 * hash(0, 3, 4), 17));
    EXPECT_EQ(scene.sky, Imath::C3f(0.3f, 0.4f, 0.6f));
    EXPECT_DOUBLE_EQ(*scene.camera.focal_length_mm / 1000 / (2 * *scene.camera.fstop), 0.06);
    EXPECT_EQ(scene.camera.focus_distance, 5);
}

TEST(Scenes, GrassIsAsWritten) {
    const Scene scene = build_scene("grass");
    ASSERT_EQ(scene.quads.size(), 2u + 200u);
    ASSERT_EQ(scene.spheres.size(), 60u);
    EXPECT_EQ(scene.spheres[2].material, dots);
    EXPECT_EQ(scene.spheres[3].material, stripes);
    const double x = -3 + 6 * hash(199, 9, 1), w = 0.01 + 0.01 * hash(199, 2, 2);
    const double t = 0.4 * (5292316 * 0x1p-24 - 0.5);
    const Imath::V3d top(x + w + t, 1, 1.8 + 8 * hash(199, 10, 1));
    EXPECT_NEAR((scene.quads.back().corners[2] - top).length(), 0, 1e-12);
}

// Parts of the plate hide the element and vice versa, and no two objects intersect.
TEST(Scenes, ElementStandsInThePlate) {
    const Scene element = build_scene("element"), plate = build_scene("plate"),
                both = build_scene("element-in-plate");
    EXPECT_EQ(both.spheres.size(), element.spheres.size() + plate.spheres.size());
    EXPECT_EQ(both.quads.size(), element.quads.size() + plate.quads.size());
    EXPECT_EQ(both.sky_coverage, 1);
    EXPECT_EQ(both.camera.fstop, element.camera.fstop);
    int hides = 0, hidden = 0;
    for (const Sphere &own : element.spheres)
        for (const Sphere &other : plate.spheres) {
            EXPECT_GT((own.centre - other.centre).length(), own.radius + other.radius);
            const auto seen = [](const Sphere &s) { return Imath::V2d(s.centre.x, s.centre.y) / s.centre.z; };
            if ((seen(own) - seen(other)).length() >
                own.radius / own.centre.z + other.radius / other.centre.z)
                continue;
            ++(own.centre.z < other.centre.z ? hides : hidden);
        }
    EXPECT_GT(hides, 0);
    EXPECT_GT(hidden, 0);
}

TEST(Scenes, PlanesStandInFrontOfInAndBehindFocus) {
    const auto planes = facing_planes();
    EXPECT_LT(planes.front().z, 5);
    EXPECT_EQ(planes[1].z, 5);
    EXPECT_GT(planes.back().z, 5);
    for (const FacingPlane &plane : planes)
        for (const PlaneWave &wave : plane.radiance) EXPECT_GT(wave.mean, wave.amplitude);
}

// Each lamp is 2 x 2 whole pixels at the default size, also in the axis-parallel rim views.
TEST(Scenes, LampsLieOnWholePixels) {
    const Scene scene = build_scene("lamps");
    const double rf = 0.12 * 640;
    const auto whole = [](double v) { return std::abs(v - std::round(v)) < 1e-9; };
    for (std::size_t i = 1; i < scene.quads.size(); ++i) {
        const auto &c = scene.quads[i].corners;
        EXPECT_NEAR((c[2].x - c[0].x) * 640 / c[0].z, 2, 1e-9);
        EXPECT_NEAR((c[2].y - c[0].y) * 640 / c[0].z, 2, 1e-9);
        EXPECT_TRUE(whole(c[0].x * 640 / c[0].z) && whole(c[0].y * 640 / c[0].z) && whole(rf / c[0].z)) << i;
    }
}

// CoC from -105 to 137 at the default size of 640 pixels; the picture's border hides no lamp.
TEST(Scenes, MacroIsNearAndItsLampsStandInThePicture) {
    const Scene scene = build_scene("macro");
    EXPECT_EQ(*scene.camera.fstop, 1);
    const double rf = 0.0425 * 85 / 36 * 640, focus = *scene.camera.focus_distance;
    double nearest = scene.quads[0].corners[0].z;
    EXPECT_NEAR(rf / focus - rf / nearest, 136, 1);
    std::size_t lamps = 0;
    for (const Sphere &sphere : scene.spheres) {
        nearest = std::min(nearest, sphere.centre.z - sphere.radius);
        if (sphere.material != head_lamp) continue;
        ++lamps;
        EXPECT_LT(std::abs(sphere.centre.x / sphere.centre.z), 18.0 / 85);
        EXPECT_LT(std::abs(sphere.centre.y / sphere.centre.z), 18.0 / 85 * 9 / 16);
    }
    EXPECT_EQ(lamps, 24u);
    EXPECT_NEAR(rf / focus - rf / nearest, -105, 1);
}

// The middle of the lens sees all of the horns' sides: towards their bases they grow faster than their apparent size
// shrinks.
TEST(Scenes, MacroHornsAreWiderAtTheBase) {
    const Scene scene = build_scene("macro");
    std::size_t steps = 0;
    for (std::size_t i = 1; i < scene.spheres.size(); ++i) {
        const Sphere &tip = scene.spheres[i - 1], &base = scene.spheres[i];
        const auto ray = [](const Sphere &s) { return s.centre / s.centre.z; };
        if ((ray(tip) - ray(base)).length() > 1e-12) continue;
        ++steps;
        EXPECT_GT(base.radius / base.centre.z, tip.radius / tip.centre.z);
    }
    EXPECT_EQ(steps, 9u * 60u);
}

} // namespace
} // namespace sparselens::lab
