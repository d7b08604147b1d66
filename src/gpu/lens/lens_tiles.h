// Gathers tiles of the lens gather on a device (lens_tile.comp). It leaves to the CPU tiles that fit into no buffer,
// and tiles for which one lens point takes more turns of loops than the device allows.
#pragma once

#include "dof/device/tile_device.h"
#include "gpu/device_worker.h"
#include "gpu/lens/stripe.h"

#include <map>
#include <vector>

namespace sparselens::gpu {

// A stripe in the buffers of a device. A new stripe is compared with the one before, and only what differs is copied.
// In a pull of focus over one LDI, the positions, depths and coverages of samples stay the same, and most of their
// colours. It need not be known whether it is the same LDI.
class StripeBuffers {
public:
    // Returns how many bytes went to the device. Throws DeviceFailed; the buffers must not be used after that.
    std::size_t bring(Device &device, Stripe &&stripe);

    const Stripe &stripe() const { return stripe_; }
    // The buffers in the order of the shader's bindings, including those that the shader writes.
    std::vector<Buffer> bindings(const Buffer &values, const Buffer &known, const Buffer &sums) const;

private:
    Stripe stripe_;
    std::vector<Buffer> buffers_;
};

class LensTilesOnDevice {
public:
    explicit LensTilesOnDevice(DeviceWorker &worker) : worker_(worker), device_(worker.device) {}

    // Like TileDevice::gather(). Throws DeviceFailed; what was done before stays done.
    void gather(const GatherScene &scene, std::span<const TileTask> tasks,
                const std::function<void(std::size_t, const TilePicture &)> &done);

private:
    const Program &program_for(std::uint32_t rules, std::uint32_t points);
    void gather_stripe(const GatherScene &scene, const Program &program, const StripeBuffers &in,
                       const std::function<void(std::size_t, const TilePicture &)> &done);
    void run(const Program &program, const Stripe &stripe, std::uint32_t pass, const GatherScene &scene,
             std::span<const Buffer> buffers);

    DeviceWorker &worker_;
    Device &device_;
    std::map<std::uint32_t, Program> programs_; // by their rules; made when they are first needed
    StripeBuffers buffers_;                     // kept for the next frame if one stripe is everything
};

} // namespace sparselens::gpu
