#include "gpu/device_worker.h"

#include "base/grid.h"

#include <algorithm>
#include <utility>

namespace sparselens::gpu {

namespace {

constexpr const char *too_many = "more samples than its buffers hold";

std::size_t counted(const DeviceReport &report) {
    std::size_t all = report.on_device;
    for (const auto &left : report.on_cpu) all += left.second;
    return all;
}

} // namespace

void DeviceWorker::unless_lost(std::size_t units, const std::function<void()> &work) {
    constexpr const char *failed = "the device failed";
    const std::size_t before = counted(report);
    if (!lost_) try {
            return work();
        } catch (const DeviceFailed &failure) {
            lost_ = true;
            report.failure = failure.what();
        }
    report.on_cpu[failed] += units - (counted(report) - before);
}

void DeviceWorker::by_stripes(std::size_t units, std::size_t least,
                              const std::function<std::size_t(std::size_t, std::size_t, std::size_t)> &fit,
                              const std::function<const char *(std::size_t, std::size_t)> &work) {
    for (std::size_t begin = 0; begin < units;) {
        std::size_t count = fit(begin, std::min(at_once_, units - begin), buffer_bytes());
        const char *why = too_many;
        if (count > 0) try {
                why = work(begin, count);
            } catch (const DeviceFull &) {
                if (count <= least) throw;
                at_once_ = pieces_of(count, 2 * least) * least;
                continue;
            }
        else
            count = std::min(least, units - begin);
        (why ? report.on_cpu[why] : report.on_device) += count;
        begin += count;
    }
}

bool DeviceWorker::holds(std::size_t bytes, std::size_t units) {
    if (bytes <= device.largest_buffer()) return true;
    report.on_cpu[too_many] += units;
    return false;
}

std::size_t DeviceWorker::buffer_bytes() const {
    return std::min(std::size_t{512} << 20, device.largest_buffer());
}

DeviceReport DeviceWorker::take_report() {
    report.ms = device.take_times();
    return std::exchange(report, {});
}

} // namespace sparselens::gpu
