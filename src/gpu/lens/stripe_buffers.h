// A stripe in the buffers of a device. A new stripe is compared with the one before, and only what differs is copied.
// In a pull of focus over one LDI, the positions, depths and coverages of samples stay the same, and most of their
// colours. It need not be known whether it is the same LDI.
#pragma once

#include "gpu/device.h"
#include "gpu/lens/stripe.h"

#include <vector>

namespace sparselens::gpu {

class StripeBuffers {
public:
    // Returns how many bytes went to the device. Throws DeviceFailed; the buffers must not be used after that.
    std::size_t bring(Device &device, Stripe &&stripe);

    const Stripe &stripe() const { return stripe_; }
    // The buffers in the order of the shader's bindings, including those that the shader writes.
    std::vector<const Buffer *> bindings(const Buffer &values, const Buffer &known, const Buffer &sums) const;

private:
    Stripe stripe_;
    std::vector<Buffer> buffers_;
};

} // namespace sparselens::gpu
