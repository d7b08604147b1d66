// The device that --device means: looked for when it is first needed, and kept for all frames.
#pragma once

#include "dof/device/tile_device.h"
#include "harness/tool.h"

#include <memory>
#include <optional>
#include <string>

namespace sparselens {

class GatherDevice {
public:
    // Null: the CPU. Throws Error where the word means a device that is not there. One that cannot be used is warned of,
    // and the CPU takes its place. With --verbose, says which it is.
    TileDevice *open(const std::string &word, const ToolContext &tool);

    // With --verbose: what it gathered, and what it left to the CPU, and why. A warning if it failed.
    void report(const ToolContext &tool);

private:
    void look_for(const std::string &word, const ToolContext &tool);

    std::optional<std::string> looked_for_; // the word
    std::string name_ = {};
    std::unique_ptr<TileDevice> device_;
};

} // namespace sparselens
