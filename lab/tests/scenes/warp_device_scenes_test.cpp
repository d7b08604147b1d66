// All test scenes, warped by the device and by the CPU.
#include "gpu/gpu_fixture.h"
#include "gpu/warp/warp_device.h"
#include "lab/tests/support/traced.h"
#include "lab/trace/scenes.h"
#include "warp/warp_fixture.h"

namespace sparselens::gpu {
namespace {

using WarpDeviceScenes = GpuTest;

TEST_F(WarpDeviceScenes, AreTheCpus) {
    const auto device = open_warp_device(*info, watch());
    for (const lab::SceneEntry &entry : lab::scene_table()) {
        SCOPED_TRACE(entry.name);
        const lab::SceneCamera scene(entry.name, 96, 54);
        const ThinLens &lens = scene.settings.lens;
        const std::vector<View> views = scene.five_views(1);
        WarpOptions options{.focal_px = lens.focal_px, .radius = lens.radius, .focus = lens.focus};
        const Ldi expected = warping::warped(views, options);
        options.device = device.get();
        warping::expect_same_bits(warping::warped(views, options), expected);
        const DeviceReport did = device->take_report();
        EXPECT_EQ(did.failure, "");
        EXPECT_TRUE(did.on_cpu.empty());
        EXPECT_EQ(did.on_device, std::size_t(expected.windows.height()));
    }
}

} // namespace
} // namespace sparselens::gpu
