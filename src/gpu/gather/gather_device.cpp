#include "gpu/gather/gather_device.h"

#include "gpu/lens/lens_tiles.h"
#include "gpu/selective/selective_tiles.h"

#include <utility>

namespace sparselens::gpu {

namespace {

class GatherDevice : public TileDevice {
public:
    GatherDevice(const DeviceInfo &info, const Watch &watch)
        : device_(info, watch), lens_(device_), selective_(device_) {}

    void gather(const GatherScene &scene, std::span<const TileTask> tasks,
                const std::function<void(std::size_t, const TilePicture &)> &done) override {
        unless_lost(tasks.size(), [&] { lens_.gather(scene, tasks, done, report_); });
    }
    void gather(const SplatScene &scene, std::span<const SplatTask> tasks,
                const std::function<void(std::size_t, const SplatPicture &)> &done) override {
        unless_lost(tasks.size(), [&] { selective_.gather(scene, tasks, done, report_); });
    }
    TileReport take_report() override {
        report_.ms = device_.take_times();
        return std::exchange(report_, {});
    }

private:
    template <typename Gather>
    void unless_lost(std::size_t tasks, const Gather &gather_tiles) {
        constexpr const char *failed = "the device failed";
        const std::size_t before = counted();
        if (!lost_) try {
                return gather_tiles();
            } catch (const DeviceFailed &failure) {
                lost_ = true;
                report_.failure = failure.what();
            }
        report_.on_cpu[failed] += tasks - (counted() - before);
    }
    std::size_t counted() const {
        std::size_t all = report_.on_device;
        for (const auto &left : report_.on_cpu) all += left.second;
        return all;
    }

    Device device_;
    LensTilesOnDevice lens_;
    SelectiveTilesOnDevice selective_;
    TileReport report_;
    bool lost_ = false;
};

} // namespace

std::unique_ptr<TileDevice> open_gather_device(const DeviceInfo &info, const Watch &watch) {
    return std::make_unique<GatherDevice>(info, watch);
}

} // namespace sparselens::gpu
