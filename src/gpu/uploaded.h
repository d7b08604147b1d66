// Values in a buffer of a device.
#pragma once

#include "gpu/device.h"

#include <span>

namespace sparselens::gpu {

template <typename Values>
Buffer uploaded(Device &device, const Values &values) {
    const auto bytes = std::as_bytes(std::span(values));
    Buffer buffer = device.buffer(bytes.size());
    device.upload(buffer, bytes);
    return buffer;
}

} // namespace sparselens::gpu
