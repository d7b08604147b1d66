// Gathers tiles of the lens gather on a device (lens_tile.comp). It leaves to the CPU tiles that fit into no buffer,
// and tiles for which one lens point takes more turns of loops than the device allows.
#pragma once

#include "dof/device/tile_device.h"
#include "gpu/device.h"
#include "gpu/lens/stripe_buffers.h"

#include <optional>

namespace sparselens::gpu {

class LensTilesOnDevice {
public:
    explicit LensTilesOnDevice(Device &device) : device_(device) {}

    // Like TileDevice::gather(). Throws DeviceFailed; what was done before stays done.
    void gather(const GatherScene &scene, std::span<const TileTask> tasks,
                const std::function<void(std::size_t, const TilePicture &)> &done, TileReport &report);

private:
    void gather_stripe(const GatherScene &scene,
                       const std::function<void(std::size_t, const TilePicture &)> &done);
    void run(std::uint32_t pass, std::size_t groups, float depth_at_1,
             std::span<const Buffer *const> buffers);

    Device &device_;
    std::optional<Program> program_; // made when it is first needed
    StripeBuffers buffers_;          // kept for the next frame if one stripe is everything
};

} // namespace sparselens::gpu
