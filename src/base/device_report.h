// What a device did of the work that it was given, and what it left to the CPU.
#pragma once

#include <cstddef>
#include <map>
#include <string>

namespace sparselens {

// Since the report was last taken. The unit of work is the device's: tiles, rows.
struct DeviceReport {
    std::size_t on_device = 0;
    std::size_t uploaded = 0;                       // bytes
    std::map<std::string, std::size_t> on_cpu = {}; // what was left to the CPU, by why, in a few words
    std::string failure = {}; // if not empty: it failed, and this says how; the CPU did the rest
};

} // namespace sparselens
