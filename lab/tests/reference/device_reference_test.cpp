// The kernels of the gathers compared with their slow references.
#include "dof/device/tile_device.h"
#include "dof/lens/lens_gather.h"
#include "dof/selective/selective.h"
#include "gpu/gather/gather_device.h"
#include "gpu/gpu_fixture.h"
#include "lab/methods/scatter.h"
#include "lab/tests/support/reference_picture.h"
#include "lens/lens_samples.h"
#include "support/lens_ldi.h"

#include <algorithm>
#include <memory>

namespace sparselens::gpu {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};

class DeviceReferenceTest : public GpuTest {};

TEST_F(DeviceReferenceTest, OfTheLensGather) {
    struct Case {
        bool opaque, images;
        std::uint32_t stream;
        LensLooks looks = {};
        bool solids = false;
    };
    const std::vector<Case> cases{{false, false, 5},
                                  {true, false, 15},
                                  {false, true, 25},
                                  {true, true, 35},
                                  {false, false, 45, {.aperture = {.blades = 5, .squeeze = 1.5}}},
                                  {false, false, 55, {.aperture = {.spherical = 0.8}, .cat_eye = 0.9}},
                                  {true, false, 65, {}, true},
                                  {false, false, 75, {.aperture = {.spherical = {0.8, 0, -0.6}}}, true}};
    Progress silent;
    const std::unique_ptr<TileDevice> device = open_gather_device(*info, watch());
    for (const Case &c : cases) {
        Ldi ldi = random_surfaces(windows_of_size(40, 30), lens, c.opaque, c.stream);
        for (std::vector<float> &values : ldi.values) // no highlights: the reference does not spread them
            for (float &value : values) value = std::min(value, 1.0f);
        for (Channel &channel : ldi.channels) // no colours: the reference does not sharpen
            if (channel.name != "A") channel.name += "0";
        for (std::size_t i = 0; i < ldi.z.size() && c.images; ++i)
            ldi.image_z.push_back(ldi.z[i] * (random_unit(int(i), 1, c.stream) < 0.5 ? 1 : 1.7f));
        for (std::size_t i = 0; i < ldi.z.size() && c.solids; ++i)
            ldi.solid.push_back(float(2 * random_unit(int(i), 2, c.stream) / (lens.radius * lens.focal_px)));
        const LensGatherOptions by{.lens_samples = 16, .looks = c.looks, .device = device.get()};
        const Image image = lens_gather(ldi, lens, ldi.windows.data, by, silent);
        EXPECT_TRUE(device->take_report().on_cpu.empty());
        const Aperture aperture(c.looks.aperture);
        const CatEye cat_eye(aperture, c.looks, picture_frame(ldi.windows, c.looks));
        expect_within(image, lens_gather_reference(ldi, lens, ldi.windows.data, lens_samples(aperture, 16, 1),
                                                   nullptr, cat_eye.cuts() ? &cat_eye : nullptr));
    }
}

TEST_F(DeviceReferenceTest, OfTheSelectiveGather) {
    const std::unique_ptr<TileDevice> device = open_gather_device(*info, watch());
    for (const bool opaque : {true, false}) {
        const Ldi ldi = random_surfaces(windows_of_size(60, 40), lens, opaque, 4);
        Progress silent;
        const Image image = selective_gather(ldi, lens, {32, device.get()}, silent);
        EXPECT_LE(largest_difference(image, scatter(ldi, lens, {}, silent)),
                  1e-4 * std::ranges::max(image.values));
    }
    EXPECT_GT(device->take_report().on_device, 0u);
}

} // namespace
} // namespace sparselens::gpu
