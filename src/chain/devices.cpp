#include "chain/devices.h"

#include <optional>

namespace sparselens {

namespace {

std::optional<gpu::DeviceInfo> find_device(const std::string &word, const Notify &notify) {
    if (word == "auto" && !gpu::may_have_gpu()) return {};
    std::string why_none; // also if a driver does not work
    const std::vector<gpu::DeviceInfo> there = gpu::list_devices(&why_none);
    if (!why_none.empty()) notify({.kind = NoticeKind::no_vulkan, .values = {why_none}});
    return gpu::choose_device(word, there);
}

void notify_done(const DeviceReport &did, const DeviceNotices &notices, const Notify &notify) {
    if (!did.failure.empty()) notify({.kind = notices.failed, .values = {did.failure}});
    std::size_t all = did.on_device;
    for (const auto &left : did.on_cpu) all += left.second;
    notify({.kind = notices.done, .values = {did.on_device, all}});
    for (const auto &[reason, count] : did.on_cpu) notify({.kind = notices.left, .values = {count, reason}});
    if (did.on_device > 0) notify({.kind = NoticeKind::uploaded, .values = {double(did.uploaded) * 1e-6}});
}

} // namespace

template <typename Device>
void KeptDevice<Device>::with(const std::string &word, const Notify &notify, Progress &progress,
                              const std::function<void(Device *)> &work) {
    if (word == "cpu") {
        notify({NoticeKind::on_cpu});
        return work(nullptr);
    }
    const std::lock_guard lock(mutex_);
    if (word_ != word) look_for(word, notify);
    if (device_)
        notify({.kind = NoticeKind::on_device, .values = {name_}});
    else
        notify({NoticeKind::on_cpu});
    if (device_) device_->take_report(); // drops that of cancelled work
    work(device_.get());
    if (!device_) return;
    const DeviceReport did = device_->take_report();
    notify_done(did, notices_, notify);
    progress.spent(did.ms);
}

template <typename Device>
void KeptDevice<Device>::look_for(const std::string &word, const Notify &notify) {
    device_.reset();
    word_.clear();
    if (const auto chosen = find_device(word, notify)) try {
            device_ = open_(*chosen, {});
            name_ = gpu::description(*chosen);
        } catch (const gpu::DeviceFailed &failure) {
            notify({.kind = notices_.unusable, .values = {failure.what()}});
        }
    word_ = word;
}

template <typename Device>
void KeptDevice<Device>::release() {
    const std::lock_guard lock(mutex_);
    device_.reset();
    word_.clear();
}

template class KeptDevice<TileDevice>;
template class KeptDevice<WarpDevice>;

} // namespace sparselens
