// All test scenes, warped and gathered by the device and by the CPU.
#include "deep/cluster.h"
#include "dof/device/tile_device.h"
#include "dof/lens/lens_gather.h"
#include "gpu/gpu_fixture.h"
#include "gpu/gather/gather_device.h"
#include "lab/trace/scenes.h"
#include "support/lens_ldi.h"
#include "support/traced.h"
#include "warp/warp.h"

#include <algorithm>

namespace sparselens::gpu {
namespace {

using LensDeviceScenes = GpuTest;

Ldi warped(const lab::SceneCamera &scene) {
    Progress silent;
    const ThinLens &lens = scene.settings.lens;
    const Ldi ldi = warp(scene.five_views(1), {.focal_px = lens.focal_px, .radius = lens.radius}, silent);
    return cluster(ldi, {.scale = lens.radius * lens.focal_px, .tolerance = 0.25}, silent).ldi;
}

TEST_F(LensDeviceScenes, AreTheCpus) {
    const auto device = open_gather_device(*info, watch());
    for (const lab::SceneEntry &entry : lab::scene_table()) {
        const std::string name = entry.name;
        const lab::SceneCamera scene(name, 96, 54);
        const Ldi ldi = warped(scene);
        const auto gather = [&](TileDevice *by) {
            Progress silent;
            return lens_gather(ldi, scene.settings.lens, ldi.windows.data, {.lens_samples = 16, .device = by},
                               silent);
        };
        const Image expected = gather(nullptr), image = gather(device.get());
        const float largest = *std::ranges::max_element(expected.values);
        EXPECT_LE(largest_difference(image, expected), 1e-4 * double(largest)) << name;
        const TileReport did = device->take_report();
        EXPECT_EQ(did.failure, "") << name;
        EXPECT_TRUE(did.on_cpu.empty()) << name;
        EXPECT_GT(did.on_device, 0u) << name;
    }
}

} // namespace
} // namespace sparselens::gpu
