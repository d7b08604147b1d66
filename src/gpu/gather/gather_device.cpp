#include "gpu/gather/gather_device.h"

#include "gpu/device_worker.h"
#include "gpu/lens/lens_tiles.h"
#include "gpu/selective/selective_tiles.h"

namespace sparselens::gpu {

namespace {

class GatherDevice : public TileDevice {
public:
    GatherDevice(const DeviceInfo &info, const Watch &watch)
        : worker_(info, watch), lens_(worker_), selective_(worker_) {}

    void gather(const GatherScene &scene, std::span<const TileTask> tasks,
                const std::function<void(std::size_t, const TilePicture &)> &done) override {
        worker_.unless_lost(tasks.size(), [&] { lens_.gather(scene, tasks, done); });
    }
    void gather(const SplatScene &scene, std::span<const SplatTask> tasks,
                const std::function<void(std::size_t, const SplatPicture &)> &done) override {
        worker_.unless_lost(tasks.size(), [&] { selective_.gather(scene, tasks, done); });
    }
    TileReport take_report() override { return worker_.take_report(); }

private:
    DeviceWorker worker_;
    LensTilesOnDevice lens_;
    SelectiveTilesOnDevice selective_;
};

} // namespace

std::unique_ptr<TileDevice> open_gather_device(const DeviceInfo &info, const Watch &watch) {
    return std::make_unique<GatherDevice>(info, watch);
}

} // namespace sparselens::gpu
