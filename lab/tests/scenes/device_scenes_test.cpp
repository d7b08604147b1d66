// All test scenes, warped and gathered by the device and by the CPU.
#include "deep/cluster.h"
#include "dof/device/tile_device.h"
#include "dof/lens/lens_gather.h"
#include "dof/selective/selective.h"
#include "gpu/gather/gather_device.h"
#include "gpu/gpu_fixture.h"
#include "lab/tests/support/traced.h"
#include "lab/trace/scenes.h"
#include "support/lens_ldi.h"
#include "warp/warp.h"

#include <algorithm>

namespace sparselens::gpu {
namespace {

Ldi warped(const lab::SceneCamera &scene) {
    Progress silent;
    const ThinLens &lens = scene.settings.lens;
    const Ldi ldi = warp(scene.five_views(1), {.focal_px = lens.focal_px, .radius = lens.radius}, silent);
    return cluster(ldi, {.scale = lens.radius * lens.focal_px, .tolerance = 0.25}, silent).ldi;
}

class DeviceScenes : public GpuTest {
protected:
    // gather(scene, ldi, device) must compute all tiles of all scenes on the device.
    template <typename Gather>
    void expect_same(const Gather &gather) {
        const auto device = open_gather_device(*info, watch());
        for (const lab::SceneEntry &entry : lab::scene_table()) {
            const std::string name = entry.name;
            const lab::SceneCamera scene(name, 96, 54);
            const Ldi ldi = warped(scene);
            const Image expected = gather(scene, ldi, nullptr), image = gather(scene, ldi, device.get());
            const float largest = *std::ranges::max_element(expected.values);
            EXPECT_LE(largest_difference(image, expected), 1e-4 * double(largest)) << name;
            const TileReport did = device->take_report();
            EXPECT_EQ(did.failure, "") << name;
            EXPECT_TRUE(did.on_cpu.empty()) << name;
            EXPECT_GT(did.on_device, 0u) << name;
        }
    }
};

TEST_F(DeviceScenes, LensGatherIsTheCpus) {
    expect_same([](const lab::SceneCamera &scene, const Ldi &ldi, TileDevice *device) {
        Progress silent;
        return lens_gather(ldi, scene.settings.lens, ldi.windows.data, {.lens_samples = 16, .device = device},
                           silent);
    });
}

TEST_F(DeviceScenes, SelectiveGatherIsTheCpus) {
    expect_same([](const lab::SceneCamera &scene, const Ldi &ldi, TileDevice *device) {
        Progress silent;
        return selective_gather(ldi, scene.settings.lens, {.layers = 4, .device = device}, silent);
    });
}

} // namespace
} // namespace sparselens::gpu
