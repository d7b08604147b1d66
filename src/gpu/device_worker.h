// Work on a device, which ends when the device fails. The report counts the work that the device did, and the work that
// is left to the CPU.
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

    // Runs work(), which does `units` of work and counts them in the report. The CPU has to do what is left if the
    // device has not enough memory, or fails, or has failed before.
    void unless_lost(std::size_t units, const std::function<void()> &work);

    // Works on `units`, at most `most` at a time. If the device has not enough memory, tries half as many at a time.
    // work(begin, count): returns why the CPU has to do them; null: they are done.
    void by_stripes(std::size_t units, std::size_t most,
                    const std::function<const char *(std::size_t, std::size_t)> &work);

    DeviceReport take_report();

private:
    std::size_t at_once_ = ~std::size_t{0}; // units; also in later pictures
    bool lost_ = false;
};

} // namespace sparselens::gpu
