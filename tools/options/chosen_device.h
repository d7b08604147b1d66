// --device: which device works. It is looked for when it is first needed, and kept for all frames.
#pragma once

#include "base/device_report.h"
#include "gpu/device.h"
#include "gpu/gather/gather_device.h"
#include "gpu/warp/warp_device.h"
#include "harness/commands/cli.h"
#include "harness/tool.h"

#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace sparselens {

// `device`: a word as choose_device() has it; `list` is answered as --help is. `what_works`, for the help: "What warps".
void add_device_option(CLI::App &app, std::string &device, const std::string &what_works);

// In messages: "the CPU gathers", "tiles gathered by the device".
struct DeviceWork {
    const char *verb, *units_done;
};

// None: the CPU. Throws Error where the word means a device that is not there. With --verbose, says why Vulkan has none: a
// driver that does not work is none, too.
std::optional<gpu::DeviceInfo> find_device(const std::string &word, const ToolContext &tool);
// As Job::keeps has it: a device, unless the word means none.
inline std::string kept_device(const std::string &word) { return word == "cpu" ? "" : "a device"; }
// With --verbose: what the device did, and what it left to the CPU, and why. A warning if it failed.
void say_report(const ToolContext &tool, const DeviceReport &did, const DeviceWork &work);

template <typename Device>
class ChosenDevice {
public:
    using Open = std::unique_ptr<Device> (*)(const gpu::DeviceInfo &);
    ChosenDevice(Open opener, const DeviceWork &work) : open_(opener), work_(work) {}

    // Null: the CPU. Throws Error where the word means a device that is not there. One that cannot be used is warned of,
    // and the CPU takes its place. With --verbose, says which it is.
    Device *open(const std::string &word, const ToolContext &tool) {
        const std::lock_guard lock(opening_);
        if (looked_for_ != word) look_for(word, tool);
        looked_for_ = word;
        tool.say("device: " + name_);
        return device_.get();
    }
    // Of what it did since the last report.
    void report(const ToolContext &tool) {
        if (device_) say_report(tool, device_->take_report(), work_);
    }

private:
    void look_for(const std::string &word, const ToolContext &tool) {
        device_.reset();
        name_ = "the CPU";
        const auto chosen = find_device(word, tool);
        if (!chosen) return;
        try {
            device_ = open_(*chosen);
            name_ = gpu::description(*chosen);
        } catch (const gpu::DeviceFailed &failure) {
            warn(tool, std::string(failure.what()) + "; the CPU " + work_.verb);
        }
    }

    Open open_;
    DeviceWork work_;
    std::mutex opening_;                    // of what follows
    std::optional<std::string> looked_for_; // the word
    std::string name_ = {};
    std::unique_ptr<Device> device_;
};

struct ChosenGatherDevice : ChosenDevice<TileDevice> {
    ChosenGatherDevice()
        : ChosenDevice([](const gpu::DeviceInfo &info) { return gpu::open_gather_device(info); },
                       {"gathers", "tiles gathered"}) {}
};
struct ChosenWarpDevice : ChosenDevice<WarpDevice> {
    ChosenWarpDevice()
        : ChosenDevice([](const gpu::DeviceInfo &info) { return gpu::open_warp_device(info); },
                       {"warps", "rows warped"}) {}
};

} // namespace sparselens
