#include "base/numbers.h"
#include "lab/tests/trace/brute_force.h"
#include "lab/tests/trace/small_scenes.h"
#include "lab/trace/tracer.h"

#include <gtest/gtest.h>

namespace sparselens::lab {
namespace {

// Rays from all parts of a lens through all parts of a picture, at all times.
std::vector<Ray> lens_rays(std::uint32_t count) {
    const RenderSettings settings = settings_of_size(640, 360);
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto r = [i](std::uint32_t k) { return unit_interval(mix_bits(i, k)); };
        rays.push_back(lens_ray(settings, {r(0) - 0.5, r(1) - 0.5}, {640 * r(2), 360 * r(3)}, r(4)));
    }
    return rays;
}

TEST(Tracer, NearestAgreesWithBruteForce) {
    for (const char *name : {"fence", "grass", "planes", "slant", "lamps", "fair"}) {
        const Scene scene = build_scene(name);
        const Tracer tracer(scene);
        const auto rays = lens_rays(5001); // not a multiple of a packet
        std::vector<Hit> hits(rays.size());
        tracer.nearest(rays, hits);
        int differ = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const auto slow = all_hits(scene, rays[i]);
            const int primitive = slow.empty() ? -1 : slow.front().primitive;
            if (hits[i].primitive != primitive) {
                ++differ;
                continue;
            }
            if (hits[i].sky()) {
                EXPECT_EQ(hits[i].t, std::numeric_limits<double>::infinity());
                continue;
            }
            EXPECT_NEAR(hits[i].t, slow.front().t, 1e-9 * slow.front().t);
            EXPECT_LT((hits[i].position - rays[i].origin - hits[i].t * rays[i].direction).length(), 1e-12);
            EXPECT_NEAR(hits[i].normal.length(), 1, 1e-9);
        }
        EXPECT_LE(differ, 1) << name; // a ray that grazes an edge
    }
}

TEST(Tracer, AllHitsAgreeWithBruteForce) {
    for (const char *name : {"grass", "fair"}) {
        const Scene scene = build_scene(name);
        const Tracer tracer(scene);
        std::vector<Hit> hits;
        int differ = 0;
        for (const Ray &ray : lens_rays(3000)) {
            tracer.all(ray, hits);
            const auto slow = all_hits(scene, ray);
            bool same = hits.size() == slow.size();
            for (std::size_t i = 0; same && i < hits.size(); ++i)
                same = hits[i].primitive == slow[i].primitive &&
                       std::abs(hits[i].t - slow[i].t) < 1e-9 * slow[i].t;
            differ += !same;
        }
        EXPECT_LE(differ, 1) << name;
    }
}

// A body that moves is blocked and painted where it is at the ray's time, with the normal that it has there.
TEST(Tracer, BodiesAreWhereTheyAreAtTheRaysTime) {
    Scene scene;
    const auto left_or_right = [](const Imath::V3d &p) { return Paint{{p.x < 0 ? 1.f : 0.f, 0, 0}}; };
    MovingBody body{{facing_quad(-1, -1, 1, 1, 5, left_or_right)}, {}, {}};
    body.motion.path = {{-3, 0, 0}, {3, 0, 0}};
    scene.bodies = {body};
    const Tracer tracer(scene);
    for (const double time : {0.0, 0.25, 0.5, 1.0}) {
        const double x = -3 + 6 * time;
        for (const double beside : {-1.1, -0.9, 0.9, 1.1}) {
            const Ray ray{{x + beside, 0, 0}, {0, 0, 10}, time};
            bool blocked = false;
            Hit hit;
            tracer.blocked({&ray, 1}, {&blocked, 1});
            tracer.nearest({&ray, 1}, {&hit, 1});
            EXPECT_EQ(blocked, std::abs(beside) < 1) << time;
            ASSERT_EQ(hit.sky(), !blocked) << time;
            if (blocked) {
                EXPECT_EQ(tracer.paint(hit).colour.x, beside < 0 ? 1 : 0) << time;
            }
        }
    }
    scene.bodies[0].motion = {.turn = 1, .pivot = {0, 0, 5}, .axis = {0, 1, 0}};
    const Ray ray{{0, 0, 0}, {0, 0, 1}, 1};
    Hit hit;
    Tracer(scene).nearest({&ray, 1}, {&hit, 1});
    EXPECT_DOUBLE_EQ(hit.t, 5);
    EXPECT_NEAR(std::abs(hit.normal.x), std::sin(0.5), 1e-12); // half of the turn is after the middle
    EXPECT_NEAR(std::abs(hit.normal.z), std::cos(0.5), 1e-12);
}

// A far, tiny sphere keeps its outline to within a small share of its radius: the lamps of "fence" are 1.5 pixels wide.
TEST(Tracer, FarSmallSpheresAreRound) {
    Scene scene;
    scene.spheres = {{{-7.3, 2.4, 17}, 0.04, white_light}};
    const Tracer tracer(scene);
    for (int i = 0; i < 1000; ++i) {
        const double angle = 0.00628318 * i;
        for (const double share : {0.999, 1.001}) {
            // Perpendicular to the direction of the centre, at a share of the radius from the centre.
            const Imath::V3d centre = scene.spheres[0].centre, forward = centre.normalized();
            const Imath::V3d x = (forward % Imath::V3d(0, 1, 0)).normalized(), y = forward % x;
            const Imath::V3d target = centre + 0.04 * share * (std::cos(angle) * x + std::sin(angle) * y);
            const Ray ray{{0, 0, 0}, target / target.z};
            Hit hit;
            tracer.nearest({&ray, 1}, {&hit, 1});
            EXPECT_EQ(hit.sky(), share > 1) << angle;
        }
    }
}

TEST(Tracer, SpheresShowTheSideThatARayMeetsFirst) {
    Scene scene;
    scene.spheres = {{{0, 0, 5}, 1, grey}};
    const Tracer tracer(scene);
    std::vector<Hit> hits;
    tracer.all({{0, 0, 0}, {0, 0, 1}}, hits);
    ASSERT_EQ(hits.size(), 1u);
    EXPECT_DOUBLE_EQ(hits[0].t, 4);
    EXPECT_EQ(hits[0].normal, Imath::V3d(0, 0, -1));
    tracer.all({{0, 0, 5}, {0, 0, 1}}, hits);
    ASSERT_EQ(hits.size(), 1u);
    EXPECT_DOUBLE_EQ(hits[0].t, 1);
    EXPECT_EQ(hits[0].normal, Imath::V3d(0, 0, -1));
}

TEST(Tracer, BlockedOnlyBeforeTheLight) {
    Scene scene;
    scene.quads = {facing_wall(4, grey)};
    const Tracer tracer(scene);
    const Ray rays[] = {{{0, 0, 0}, {0, 0, 3}}, {{0, 0, 0}, {0, 0, 5}}, {{0, 0, 0}, {0, 0, -5}}};
    bool blocked[3];
    tracer.blocked(rays, blocked);
    EXPECT_FALSE(blocked[0]);
    EXPECT_TRUE(blocked[1]);
    EXPECT_FALSE(blocked[2]);
}

TEST(Tracer, AnEmptySceneIsSky) {
    const Tracer tracer{Scene()};
    const Ray ray{{0, 0, 0}, {0, 0, 1}};
    Hit hit;
    tracer.nearest({&ray, 1}, {&hit, 1});
    EXPECT_TRUE(hit.sky());
}

} // namespace
} // namespace sparselens::lab
