#include "loading/gather_device.h"

#include "gpu/gather/gather_device.h"

#include <fmt/format.h>

#include <utility>

namespace sparselens {

void GatherDevice::look_for(const std::string &word, const ToolContext &tool) {
    device_.reset();
    name_ = "the CPU";
    if (word == "cpu" || (word == "auto" && !gpu::may_have_gpu())) return;
    const auto chosen = gpu::choose_device(word, gpu::list_devices());
    if (!chosen) return;
    try {
        device_ = gpu::open_gather_device(*chosen);
        name_ = gpu::description(*chosen);
    } catch (const gpu::DeviceFailed &failure) {
        warn(tool, std::string(failure.what()) + "; the CPU gathers");
    }
}

TileDevice *GatherDevice::open(const std::string &word, const ToolContext &tool) {
    if (looked_for_ != word) look_for(word, tool);
    looked_for_ = word;
    tool.say("device: " + name_);
    return device_.get();
}

void GatherDevice::report(const ToolContext &tool) {
    if (!device_) return;
    const TileReport did = device_->take_report();
    if (!did.failure.empty()) warn(tool, did.failure + "; the CPU gathers what it has not");
    std::size_t all = did.on_device;
    for (const auto &left : did.on_cpu) all += left.second;
    std::string line = fmt::format("tiles gathered by the device: {} of {}", did.on_device, all);
    const char *before = "; by the CPU: ";
    for (const auto &[reason, tiles] : did.on_cpu)
        line += fmt::format("{}{} ({})", std::exchange(before, ", "), tiles, reason);
    tool.say(line);
    if (did.on_device > 0)
        tool.say(fmt::format("uploaded to the device: {:.1f} MB", double(did.uploaded) * 1e-6));
}

} // namespace sparselens
