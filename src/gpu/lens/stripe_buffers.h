// A stripe in the buffers of a device. What is brought there is compared with the stripe that was there before, and of what is
// the same nothing is copied: in a pull of focus over one LDI these are the positions, depths and coverages of its samples,
// and most of their colours. Whether it is the same LDI need not be known.
#pragma once

#include "gpu/device.h"
#include "gpu/lens/stripe.h"

#include <vector>

namespace sparselens::gpu {

class StripeBuffers {
public:
    // Returns how many bytes went to the device. Throws DeviceFailed, after which the buffers are of no use.
    std::size_t bring(Device &device, Stripe &&stripe);

    const Stripe &stripe() const { return stripe_; }
    // In the order of the shader's bindings, with those that it writes.
    std::vector<const Buffer *> bindings(const Buffer &values, const Buffer &known, const Buffer &sums) const;

private:
    Stripe stripe_;
    std::vector<Buffer> buffers_;
};

} // namespace sparselens::gpu
