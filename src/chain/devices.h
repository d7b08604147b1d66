// Devices that work for the chain. A device is searched for when it is first requested, and kept for later work.
#pragma once

#include "chain/notices.h"
#include "gpu/gather/gather_device.h"
#include "gpu/warp/warp_device.h"

#include <functional>
#include <memory>
#include <mutex>
#include <string>

namespace sparselens {

// The notices about a device: why it works or fails, what it has done, and what the CPU does.
struct DeviceNotices {
    NoticeKind unusable, failed, done, left;
};

template <typename Device>
class KeptDevice {
public:
    using Open = std::unique_ptr<Device> (*)(const gpu::DeviceInfo &, const gpu::Watch &);
    KeptDevice(Open opener, const DeviceNotices &notices) : open_(opener), notices_(notices) {}

    // Calls work(device) with the device that `word` means, as for choose_device() of gpu/device_list.h; null: the CPU.
    // One piece of work at a time has the device, others wait. Reports which device it is and what it did. Throws Error
    // if that device does not exist; if it cannot be used, it gives a warning and uses the CPU. The progress counts the
    // device's times.
    void with(const std::string &word, const Notify &notify, Progress &progress,
              const std::function<void(Device *)> &work);

    // Closes the device.
    void release();

private:
    void look_for(const std::string &word, const Notify &notify);

    Open open_;
    DeviceNotices notices_;
    std::mutex mutex_; // guards the variables below
    std::string word_ = {}, name_ = {};
    std::unique_ptr<Device> device_;
};

struct GatherDevice : KeptDevice<TileDevice> {
    GatherDevice()
        : KeptDevice(gpu::open_gather_device, {NoticeKind::gather_unusable, NoticeKind::gather_failed,
                                               NoticeKind::gathered_tiles, NoticeKind::left_tiles}) {}
};
struct WarpingDevice : KeptDevice<WarpDevice> {
    WarpingDevice()
        : KeptDevice(gpu::open_warp_device, {NoticeKind::warp_unusable, NoticeKind::warp_failed,
                                             NoticeKind::warped_rows, NoticeKind::left_rows}) {}
};

} // namespace sparselens
