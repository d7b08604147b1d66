// Devices that work for the chain: looked for when a word first asks for one, and kept for what comes next.
#pragma once

#include "chain/notices.h"
#include "gpu/gather/gather_device.h"
#include "gpu/warp/warp_device.h"

#include <functional>
#include <memory>
#include <mutex>
#include <string>

namespace sparselens {

// The notices that say what a device has done, and what it has not.
struct DeviceNotices {
    NoticeKind unusable, failed, done, left;
};

template <typename Device>
class KeptDevice {
public:
    using Open = std::unique_ptr<Device> (*)(const gpu::DeviceInfo &, const gpu::Watch &);
    KeptDevice(Open opener, const DeviceNotices &notices) : open_(opener), notices_(notices) {}

    // Calls work(device) with what `word` means, as choose_device() of gpu/device_list.h has it; null: the CPU. One work at a
    // time has the device, others wait. Says which device it is and what it did. Throws Error where the word means a device that
    // is not there; one that cannot be used is warned of, and the CPU takes its place.
    void with(const std::string &word, const Tell &tell, const std::function<void(Device *)> &work);

    // Gives the device back.
    void release();

private:
    void look_for(const std::string &word, const Tell &tell);

    Open open_;
    DeviceNotices notices_;
    std::mutex mutex_; // of what follows
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
