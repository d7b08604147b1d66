#include "gpu/device_worker.h"

#include "base/grid.h"

#include <algorithm>
#include <utility>

namespace sparselens::gpu {

namespace {

std::size_t counted(const DeviceReport &report) {
    std::size_t all = report.on_device;
    for (const auto &left : report.on_cpu) all += left.second;
    return all;
}

} // namespace

void DeviceWorker::unless_lost(std::size_t units, const std::function<void()> &work) {
    const std::size_t before = counted(report);
    const char *why = "the device failed";
    if (!lost_) try {
            device.finish(); // frees the memory of work that ended early
            return work();
        } catch (const DeviceFull &full) {
            report.failure = full.what();
            why = "the device has not enough memory";
        } catch (const DeviceFailed &failure) {
            report.failure = failure.what();
            lost_ = true;
        }
    report.on_cpu[why] += units - (counted(report) - before);
}

void DeviceWorker::by_stripes(std::size_t units, std::size_t most,
                              const std::function<const char *(std::size_t, std::size_t)> &work) {
    for (std::size_t begin = 0; begin < units;) {
        const std::size_t count = std::min({at_once_, most, units - begin});
        try {
            const char *why = work(begin, count);
            (why ? report.on_cpu[why] : report.on_device) += count;
            begin += count;
        } catch (const DeviceFull &) {
            if (count == 1) throw;
            device.finish(); // frees the memory of recorded work
            at_once_ = pieces_of(count, std::size_t{2});
        }
    }
}

DeviceReport DeviceWorker::take_report() {
    report.ms = device.take_times();
    return std::exchange(report, {});
}

} // namespace sparselens::gpu
