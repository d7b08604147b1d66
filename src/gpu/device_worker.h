// Work on a device. The work is done in stripes, because the whole may not fit into the device's memory, and ends when
// the device fails. The report counts what the device did, and what is left to the CPU.
#pragma once

#include "base/progress.h"
#include "gpu/device.h"

#include <cstddef>
#include <functional>

namespace sparselens::gpu {

class DeviceWorker {
public:
    DeviceWorker(const DeviceInfo &info, const Watch &watch) : device(info, watch) {}

    Device device;
    DeviceReport report;

    // Runs work(), which does `units` of work and counts them in the report. If the device fails, or has failed before,
    // the CPU has to do the rest.
    void unless_lost(std::size_t units, const std::function<void()> &work);

    // Works on `units`, some of them at once. If the device is full, half as many are tried; no fewer than `least`.
    // fit(begin, most, bytes): how many, from `begin` on and at most so many, fit into buffers of this size; 0: none.
    // work(begin, count): returns why the CPU has to do them; null: they are done.
    void by_stripes(std::size_t units, std::size_t least,
                    const std::function<std::size_t(std::size_t, std::size_t, std::size_t)> &fit,
                    const std::function<const char *(std::size_t, std::size_t)> &work);

    // Whether a buffer can have so many bytes. If not, the report says that the CPU has to do the `units`.
    bool holds(std::size_t bytes, std::size_t units);

    std::size_t buffer_bytes() const; // of a buffer, at most
    DeviceReport take_report();

private:
    std::size_t at_once_ = ~std::size_t{0}; // units; also in later pictures
    bool lost_ = false;
};

} // namespace sparselens::gpu
