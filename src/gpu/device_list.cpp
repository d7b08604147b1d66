#include "gpu/device_list.h"

#include "base/error.h"
#include "base/text.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

namespace sparselens::gpu {

namespace {

const char *words_of(Kind kind) {
    switch (kind) {
    case Kind::discrete: return "discrete GPU";
    case Kind::integrated: return "integrated GPU";
    case Kind::shared: return "shared GPU";
    case Kind::software: return "in software";
    case Kind::other: break;
    }
    return "of another kind";
}

std::string all_of(std::span<const DeviceInfo> there) {
    if (there.empty()) return no_devices;
    std::string text = "there is ";
    for (const DeviceInfo &device : there)
        text += (&device == there.data() ? "" : ", ") + description(device);
    return text;
}

std::optional<DeviceInfo> best_gpu(std::span<const DeviceInfo> there) {
    for (const Kind kind : {Kind::discrete, Kind::integrated, Kind::shared})
        for (const DeviceInfo &device : there)
            if (device.kind == kind && device.lacks.empty()) return device;
    return {};
}

} // namespace

bool may_have_gpu() {
    std::error_code none;
    // Linux: the render nodes of the kernel's drivers, NVIDIA's own node, and the node of a Windows host (WSL).
    constexpr std::array nodes{"/dev/dri", "/dev/nvidiactl", "/dev/dxg"};
    return std::ranges::any_of(nodes, [&](const char *node) { return std::filesystem::exists(node, none); });
}

std::string description(const DeviceInfo &device) {
    const std::string text = device.name + " (" + words_of(device.kind);
    return text + (device.lacks.empty() ? ")" : ", lacks " + device.lacks + ")");
}

std::optional<DeviceInfo> choose_device(std::string_view word, std::span<const DeviceInfo> there) {
    if (word == "cpu") return {};
    if (word == "auto" || word == "gpu") {
        const std::optional<DeviceInfo> best = best_gpu(there);
        if (!best && word == "gpu")
            throw Error("`device=gpu`: no GPU can be used; " + all_of(there) + ". Use `device=cpu`");
        return best;
    }
    const std::string part = lower_case(std::string(word));
    const auto named = std::ranges::find_if(there, [&](const DeviceInfo &device) {
        return lower_case(device.name).find(part) != std::string::npos;
    });
    const std::string asked = "`device=" + std::string(word) + "`: ";
    if (named == there.end()) throw Error(asked + "no device has that name; " + all_of(there));
    if (!named->lacks.empty()) throw Error(asked + description(*named) + ". Use `device=cpu`");
    return *named;
}

} // namespace sparselens::gpu
