#include "base/random.h"
#include "lab/tests/trace/brute_force.h"
#include "lab/tests/trace/small_scenes.h"
#include "lab/trace/tracer.h"

#include <gtest/gtest.h>

namespace sparselens::lab {
namespace {

// Rays from all parts of a lens through all parts of a picture.
std::vector<Ray> lens_rays(std::uint32_t count) {
    const RenderSettings settings = settings_of_size(640, 360);
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto r = [i](std::uint32_t k) { return unit_interval(mix_bits(i, k)); };
        rays.push_back(lens_ray(settings, {r(0) - 0.5, r(1) - 0.5}, {640 * r(2), 360 * r(3)}));
    }
    return rays;
}

TEST(Tracer, NearestAgreesWithBruteForce) {
    for (const char *name : {"fence", "grass", "planes", "slant", "lamps"}) {
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
    const Scene scene = build_scene("grass");
    const Tracer tracer(scene);
    std::vector<Hit> hits;
    int differ = 0;
    for (const Ray &ray : lens_rays(3000)) {
        tracer.all(ray, hits);
        const auto slow = all_hits(scene, ray);
        bool same = hits.size() == slow.size();
        for (std::size_t i = 0; same && i < hits.size(); ++i)
            same =
                hits[i].primitive == slow[i].primitive && std::abs(hits[i].t - slow[i].t) < 1e-9 * slow[i].t;
        differ += !same;
    }
    EXPECT_LE(differ, 1);
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
