#include "chain/devices.h"

#include <optional>

namespace sparselens {

namespace {

std::optional<gpu::DeviceInfo> find_device(const std::string &word, const Tell &tell) {
    if (word == "auto" && !gpu::may_have_gpu()) return {};
    std::string why_none; // also if a driver does not work
    const std::vector<gpu::DeviceInfo> there = gpu::list_devices(&why_none);
    if (!why_none.empty()) tell({.kind = NoticeKind::no_vulkan, .values = {why_none}});
    return gpu::choose_device(word, there);
}

void tell_done(const DeviceReport &did, const DeviceNotices &notices, const Tell &tell) {
    if (!did.failure.empty()) tell({.kind = notices.failed, .values = {did.failure}});
    std::size_t all = did.on_device;
    for (const auto &left : did.on_cpu) all += left.second;
    tell({.kind = notices.done, .values = {did.on_device, all}});
    for (const auto &[reason, count] : did.on_cpu) tell({.kind = notices.left, .values = {count, reason}});
    if (did.on_device > 0) tell({.kind = NoticeKind::uploaded, .values = {double(did.uploaded) * 1e-6}});
}

} // namespace

template <typename Device>
void KeptDevice<Device>::with(const std::string &word, const Tell &tell, Progress &progress,
                              const std::function<void(Device *)> &work) {
    if (word == "cpu") {
        tell({NoticeKind::on_cpu});
        return work(nullptr);
    }
    const std::lock_guard lock(mutex_);
    if (word_ != word) look_for(word, tell);
    if (device_)
        tell({.kind = NoticeKind::on_device, .values = {name_}});
    else
        tell({NoticeKind::on_cpu});
    work(device_.get());
    if (!device_) return;
    const DeviceReport did = device_->take_report();
    tell_done(did, notices_, tell);
    progress.spent(did.ms);
}

template <typename Device>
void KeptDevice<Device>::look_for(const std::string &word, const Tell &tell) {
    device_.reset();
    word_.clear();
    if (const auto chosen = find_device(word, tell)) try {
            device_ = open_(*chosen, {});
            name_ = gpu::description(*chosen);
        } catch (const gpu::DeviceFailed &failure) {
            tell({.kind = notices_.unusable, .values = {failure.what()}});
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
