// The work that a device did, and the work that it left to the CPU.
#pragma once

#include <cstddef>
#include <map>
#include <string>

namespace sparselens {

// The work since the report was last taken. The device chooses the unit of work: tiles or rows.
struct DeviceReport {
    std::size_t on_device = 0;
    std::size_t uploaded = 0;                       // bytes
    std::map<std::string, std::size_t> on_cpu = {}; // work left to the CPU, by its reason in a few words
    std::string failure = {};                       // not empty: how the device failed; the CPU did the rest
};

} // namespace sparselens
