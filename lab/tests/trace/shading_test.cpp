#include "lab/tests/trace/small_scenes.h"
#include "lab/trace/materials.h"
#include "lab/trace/sampling.h"
#include "lab/trace/shading.h"

#include <gtest/gtest.h>

namespace sparselens::lab {
namespace {

Imath::C4f seen(const Scene &scene, Light light, const Imath::V2d &light_point = {0.5, 0.5}) {
    const Tracer tracer(scene);
    const Ray ray{{0, 0, 0}, {0, 0, 1}};
    Imath::C4f out;
    trace_radiance(tracer, light, {&ray, 1}, {&light_point, 1}, {&out, 1});
    return out;
}

// The colour of the first quad's material when it reflects nothing.
float lit_chrome(Scene scene) {
    scene.mirrors = false;
    return seen(scene, Light::sun).r;
}

// l = (0.4, 0.8, -0.5) / sqrt(1.05).
TEST(Shading, SunIsTheScenesFormula) {
    Scene scene;
    scene.quads = {facing_wall(5, grey)};
    EXPECT_NEAR(seen(scene, Light::sun).r, 0.5 * (0.9 * 0.5 / std::sqrt(1.05) + 0.15), 1e-6);
    // A slope facing up and towards the camera: n = (0, 1, -1) / sqrt(2).
    scene.quads = {{{{{-9, -1, 4}, {9, -1, 4}, {9, 1, 6}, {-9, 1, 6}}}, grey}};
    EXPECT_NEAR(seen(scene, Light::sun).r, 0.5 * (0.9 * 1.3 / std::sqrt(2.1) + 0.15), 1e-6);
}

TEST(Shading, FlatSurfacesAreLitFromBothSides) {
    Scene scene;
    scene.quads = {{{{{-9, -1, 4}, {-9, 1, 6}, {9, 1, 6}, {9, -1, 4}}}, grey}}; // the other way round
    EXPECT_NEAR(seen(scene, Light::sun).r, 0.5 * (0.9 * 1.3 / std::sqrt(2.1) + 0.15), 1e-6);
}

TEST(Shading, SkyIsOpaqueAndLampsKeepTheirRadiance) {
    Scene scene;
    scene.sky = {0.3f, 0.4f, 0.6f};
    EXPECT_EQ(seen(scene, Light::sun), Imath::C4f(0.3f, 0.4f, 0.6f, 1));
    EXPECT_EQ(seen(scene, Light::area), Imath::C4f(0.3f, 0.4f, 0.6f, 1));
    scene.quads = {facing_wall(5, white_light)};
    EXPECT_EQ(seen(scene, Light::sun), Imath::C4f(1, 1, 1, 1));
    EXPECT_EQ(seen(scene, Light::area), Imath::C4f(1, 1, 1, 1));
}

TEST(Shading, AlbedoIsTheColourWithoutLight) {
    Scene scene;
    scene.sky = {3, 2, 0.6f};
    EXPECT_EQ(seen(scene, Light::albedo), Imath::C4f(1, 1, 0.6f, 1));
    scene.quads = {facing_wall(5, grey)};
    EXPECT_EQ(seen(scene, Light::albedo), Imath::C4f(0.5f, 0.5f, 0.5f, 1));
    scene.quads = {facing_wall(5, white_light)};
    EXPECT_EQ(seen(scene, Light::albedo), Imath::C4f(1, 1, 1, 1));
}

// A mirror shows the normal of the reflected surface.
TEST(Shading, NormalsAreColours) {
    Scene scene;
    EXPECT_EQ(seen(scene, Light::normal), Imath::C4f(0, 0, 0, 1));
    scene.quads = {{{{{-9, -1, 4}, {9, -1, 4}, {9, 1, 6}, {-9, 1, 6}}}, grey}}; // a slope
    const Imath::C4f slope = seen(scene, Light::normal);
    EXPECT_NEAR(std::abs(slope.g), std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(slope.b, -slope.g, 1e-6);
    EXPECT_EQ(slope.r, 0);
    scene.mirrors = true;
    scene.quads = {{{{{-1, -1, 4}, {1, -1, 6}, {1, 1, 6}, {-1, 1, 4}}}, silver},
                   {{{{3, -9, -9}, {3, -9, 9}, {3, 9, 9}, {3, 9, -9}}}, grey}};
    const Imath::C4f wall = seen(scene, Light::normal);
    EXPECT_NEAR(std::abs(wall.r), 1, 1e-6);
    EXPECT_NEAR(wall.g, 0, 1e-6);
}

// The sheet covers half of the wall; a slab has no normal.
TEST(Shading, WhatDenoisersAskForIsCompositedLikeThePicture) {
    Scene scene;
    scene.translucent = true;
    scene.quads = {facing_wall(4, half_red), facing_wall(5, grey)};
    EXPECT_NEAR(seen(scene, Light::albedo).r, 0.75, 1e-6);
    EXPECT_NEAR(seen(scene, Light::albedo).g, 0.25, 1e-6);
    EXPECT_NEAR(std::abs(seen(scene, Light::normal).b), 1, 1e-6);
    scene.slabs = {{.z_front = 1, .z_back = 2, .density = 1, .colour = {1, 1, 1}}};
    EXPECT_NEAR(std::abs(seen(scene, Light::normal).b), std::exp(-1), 1e-6);
    EXPECT_EQ(seen(scene, Light::normal).r, 0);
}

// A mirror at 45 degrees turns the view to the right; with two mirrors the second shows its own colour.
TEST(Shading, MirrorsShowOneBounce) {
    Scene scene;
    scene.mirrors = true;
    scene.sky = {0, 0, 1};
    scene.quads = {{{{{-1, -1, 4}, {1, -1, 6}, {1, 1, 6}, {-1, 1, 4}}}, chrome}};
    EXPECT_NEAR(seen(scene, Light::sun).b, 0.1 * double(lit_chrome(scene)) + 0.9, 1e-6);
    const double dark = double(seen(scene, Light::sun).r); // no red in the sky: the mirror's own
    scene.quads.push_back({{{{3, -9, -9}, {3, -9, 9}, {3, 9, 9}, {3, 9, -9}}}, white_light});
    EXPECT_NEAR(seen(scene, Light::sun).r, dark + 0.9, 1e-6);
    EXPECT_NEAR(seen(scene, Light::area).r, seen(scene, Light::sun).r, 0.1);
    scene.quads.back().material = chrome;
    EXPECT_LT(seen(scene, Light::sun).r, 0.1);
    scene.mirrors = false;
    EXPECT_LT(seen(scene, Light::sun).b, 0.1);
}

Paint thin_glass(const Imath::V3d &) { return {{0, 0, 0}, 1, true, 1, 0, 0.5f}; }
Paint bands(const Imath::V3d &p) { return {{float(p.x), float(p.y), float(p.z)}, 1, true}; }
Paint rough_silver(const Imath::V3d &) { return {{0, 0, 0}, 1, true, 1, 0.1f}; }

// Snell: sin a = 1.5 sin b at both faces; behind the glass the ray continues in its old direction.
TEST(Shading, GlassDisplacesRays) {
    Scene scene;
    scene.mirrors = true;
    scene.quads = {facing_wall(2, thin_glass), facing_wall(6, bands)};
    const Tracer tracer(scene);
    const double slope = 0.75, within = 0.6 / 1.5 / std::sqrt(1 - 0.16); // sine 0.6 outside, 0.4 in the glass
    const Ray ray{{0, 0, 0}, {slope, 0, 1}};
    const Imath::V2d light_point(0.5, 0.5);
    Imath::C4f out;
    trace_radiance(tracer, Light::sun, {&ray, 1}, {&light_point, 1}, {&out, 1});
    EXPECT_NEAR(out.r, slope * 5.5 + within * 0.5, 1e-4);
    EXPECT_NEAR(out.b, 6, 1e-4);
}

TEST(Shading, RoughMirrorsScatterEvenlyOverADisc) {
    Scene scene;
    scene.mirrors = true;
    scene.quads = {facing_wall(4, rough_silver), facing_wall(-6, bands)};
    const Imath::C4f middle = seen(scene, Light::sun, {0, 0.3});
    EXPECT_NEAR(middle.r, 0, 1e-5);
    EXPECT_NEAR(middle.g, 0, 1e-5);
    for (const double turn : {0.0, 0.2, 0.7}) {
        const Imath::C4f half = seen(scene, Light::sun, {0.25, turn}),
                         rim = seen(scene, Light::sun, {1, turn});
        EXPECT_NEAR(std::hypot(half.r, half.g), 0.5, 1e-4); // 10 * 0.1 * sqrt(0.25)
        EXPECT_NEAR(std::hypot(rim.r, rim.g), 1, 1e-4);
    }
}

// From inside, the farther side is visible, and its normal points inwards.
TEST(Shading, SpheresAroundTheCameraAreSeenFromInside) {
    Scene scene;
    scene.spheres = {{{0, 0, 1}, 5, bands}};
    EXPECT_NEAR(seen(scene, Light::sun).b, 6, 1e-5);
    const Tracer tracer(scene);
    const Ray ray{{0, 0, 0}, {0, 0, 1}};
    Hit hit;
    tracer.nearest({&ray, 1}, {&hit, 1});
    EXPECT_NEAR(hit.normal.z, -1, 1e-9);
}

// An object before the light leaves the constant term unchanged; a small screen removes part of the light.
TEST(Shading, AreaLightCastsSoftShadows) {
    const PixelSamples samples(256, false, 0);
    std::vector<Imath::V2d> points(256);
    samples.on_light(0, 0, 0, points);
    const auto mean = [&](const Scene &scene) {
        double sum = 0;
        for (const Imath::V2d &point : points) sum += double(seen(scene, Light::area, point).r);
        return sum / 256;
    };
    Scene open;
    open.quads = {facing_wall(6, grey)};
    Scene roofed = open, screened = open;
    roofed.quads.push_back({{{{-100, 1, -100}, {100, 1, -100}, {100, 1, 6}, {-100, 1, 6}}}, grey});
    screened.quads.push_back({{{{-0.2, 1, 4}, {1.2, 1, 4}, {1.2, 1, 5.9}, {-0.2, 1, 5.9}}}, grey});
    EXPECT_GT(mean(open), 0.2);
    EXPECT_NEAR(seen(roofed, Light::area).r, 0.5 * 0.15, 1e-6);
    EXPECT_GT(mean(screened), mean(roofed) + 0.01);
    EXPECT_LT(mean(screened), mean(open) - 0.01);
}

TEST(Shading, ClosedBodiesShadowThemselves) {
    Scene scene;
    scene.spheres = {{{0, 0, -3}, 2, grey}}; // the visible side is turned away from the light
    const Tracer tracer(scene);
    const Ray away{{0, -9, -3}, {0, 1, 0}};
    const Imath::V2d point(0.5, 0.5);
    Imath::C4f out;
    trace_radiance(tracer, Light::area, {&away, 1}, {&point, 1}, {&out, 1});
    EXPECT_NEAR(out.r, 0.5 * 0.15, 1e-6);
}

TEST(Shading, PartialCoverageCompositesEveryHit) {
    Scene scene;
    scene.translucent = true;
    scene.quads = {facing_wall(8, blue_light), facing_wall(4, half_red)};
    scene.slabs = {{5, 7, 0.5, {0, 1, 0}}};
    const Imath::C4f c = seen(scene, Light::sun);
    EXPECT_NEAR(c.r, 0.5, 1e-6);
    EXPECT_NEAR(c.g, 0.5 * (1 - std::exp(-1)), 1e-6);
    EXPECT_NEAR(c.b, 0.5 * std::exp(-1), 1e-6);
    EXPECT_NEAR(c.a, 1, 1e-6);
    const Tracer tracer(scene);
    EXPECT_DOUBLE_EQ(visible_depth(tracer, {{0, 0, 0}, {0, 0, 1}}), 4); // half is covered
}

} // namespace
} // namespace sparselens::lab
