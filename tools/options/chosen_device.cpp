#include "options/chosen_device.h"

#include "gpu/device_list.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <utility>
#include <vector>

namespace sparselens {

void add_device_option(CLI::App &app, std::string &device, const std::string &what_works) {
    const auto list = [](const std::string &word) {
        if (word != "list") return;
        std::string lines;
        for (const gpu::DeviceInfo &there : gpu::list_devices()) lines += "\n" + gpu::description(there);
        throw CLI::CallForVersion(lines.empty() ? gpu::no_devices : lines.substr(1), 0);
    };
    app.add_option(
           "--device", device,
           what_works +
               ". cpu: the CPU; auto: a GPU if there is one; gpu: a GPU, else an error; a part of a name: "
               "the device of that name, even one in software; list: print the devices (default: cpu)")
        ->type_name("cpu|auto|gpu|list")
        ->group("Device")
        ->envname("SPARSELENS_DEVICE")
        ->each(list);
}

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
