#include "loading/chosen_device.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

namespace sparselens {

std::optional<gpu::DeviceInfo> find_device(const std::string &word, const ToolContext &tool) {
    if (word == "cpu" || (word == "auto" && !gpu::may_have_gpu())) return {};
    std::string why_none;
    const std::vector<gpu::DeviceInfo> there = gpu::list_devices(&why_none);
    if (!why_none.empty()) tool.say("no device by Vulkan: " + why_none);
    return gpu::choose_device(word, there);
}

void say_report(const ToolContext &tool, const DeviceReport &did, const DeviceWork &work) {
    if (!did.failure.empty())
        warn(tool, fmt::format("{}; the CPU {} what it has not", did.failure, work.verb));
    std::size_t all = did.on_device;
    for (const auto &left : did.on_cpu) all += left.second;
    std::string line = fmt::format("{} by the device: {} of {}", work.units_done, did.on_device, all);
    const char *before = "; by the CPU: ";
    for (const auto &[reason, count] : did.on_cpu)
        line += fmt::format("{}{} ({})", std::exchange(before, ", "), count, reason);
    tool.say(line);
    if (did.on_device > 0)
        tool.say(fmt::format("uploaded to the device: {:.1f} MB", double(did.uploaded) * 1e-6));
}

} // namespace sparselens
