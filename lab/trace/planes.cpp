#include "lab/trace/planes.h"

#include <cmath>

namespace sparselens::lab {

namespace {

// The default picture spans slopes of +-0.5 by +-0.28, 640 pixels per unit of slope: 100 radians per slope are 40
// pixels per period. The planes are in front of focus on the left, in focus in the middle, behind it on the right, and
// behind it over the whole picture.
const std::array<FacingPlane, 4> planes = {{
    {2.5,
     {{-0.9, -0.9}, {-0.2, 0.9}},
     {{{0.5, 0.35, {100, 40}, 0.3}, {0.4, 0.3, {60, -110}, 1.1}, {0.3, 0.2, {-150, 70}, 2.0}}}},
    {5,
     {{-0.12, -0.9}, {0.12, 0.17}},
     {{{0.5, 0.4, {220, 0}, 0.0}, {0.5, 0.4, {0, 260}, 0.5}, {0.5, 0.4, {180, 180}, 1.0}}}},
    {12,
     {{0.2, -0.9}, {0.9, 0.1}},
     {{{0.3, 0.2, {130, -50}, 0.7}, {0.5, 0.3, {90, 90}, 1.9}, {0.6, 0.35, {-40, 160}, 0.2}}}},
    {24,
     {{-2, -2}, {2, 2}},
     {{{0.6, 0.25, {70, 20}, 0.9}, {0.3, 0.2, {30, 90}, 0.1}, {0.2, 0.15, {110, -110}, 1.5}}}},
}};

template <std::size_t index>
Paint facing_plane(const Imath::V3d &p) {
    const auto &waves = planes[index].radiance;
    const Imath::V2d slope = Imath::V2d(p.x, p.y) / planes[index].z;
    return {{float(radiance(waves[0], slope)), float(radiance(waves[1], slope)),
             float(radiance(waves[2], slope))},
            1,
            true};
}

constexpr std::array<Material, 4> materials = {facing_plane<0>, facing_plane<1>, facing_plane<2>,
                                               facing_plane<3>};

} // namespace

std::span<const FacingPlane> facing_planes() { return planes; }

double radiance(const PlaneWave &wave, const Imath::V2d &slope) {
    return wave.mean + wave.amplitude * std::sin((wave.frequency ^ slope) + wave.phase);
}

Scene planes_scene(const Camera &camera) {
    Scene scene;
    scene.sky = {0, 0, 0};
    scene.camera = camera;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const double z = planes[i].z;
        const Imath::V2d a = z * planes[i].slopes.min, b = z * planes[i].slopes.max;
        scene.quads.push_back({{{{a.x, a.y, z}, {b.x, a.y, z}, {b.x, b.y, z}, {a.x, b.y, z}}}, materials[i]});
    }
    return scene;
}

} // namespace sparselens::lab
