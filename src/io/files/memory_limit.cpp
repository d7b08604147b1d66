#include "io/files/memory_limit.h"

#include "base/error.h"
#include "base/system/system.h"
#include "io/files/file_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>

namespace sparselens {

namespace {

constexpr double base_bytes = 64.0 * 1024 * 1024, bytes_per_byte = 1100;
constexpr std::uint64_t by_size = 0;

std::atomic<std::uint64_t> process_limit = by_size;

std::string megabytes(double bytes) { return fmt::format("{:.0f} MB", std::ceil(bytes / (1024 * 1024))); }

} // namespace

std::uint64_t memory_of_machine(const std::string &root) {
    std::uint64_t least = system::physical_memory(), limit;
    std::ifstream groups(root + "/proc/self/cgroup"); // lines like 0::/a/b (version 2) and 4:cpu,memory:/a/b
    for (std::string number, kinds, group;
         std::getline(std::getline(std::getline(groups, number, ':'), kinds, ':'), group);) {
        if (!kinds.empty() && kinds.find("memory") == std::string::npos) continue;
        const std::string top = root + (kinds.empty() ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory"),
                          name = kinds.empty() ? "/memory.max" : "/memory.limit_in_bytes";
        for (std::string at = top + group; at.size() >= top.size();
             at.resize(at.rfind('/')))                                             // and its parents
            if (std::ifstream(at + name) >> limit) least = std::min(least, limit); // not "max"
    }
    return least;
}

void set_memory_limit(std::optional<std::uint64_t> bytes) { process_limit = bytes.value_or(by_size); }

void check_memory(const std::string &path, double bytes, std::uint64_t file_size) {
    const std::uint64_t set = process_limit;
    const double allowed = set == by_size ? base_bytes + bytes_per_byte * double(file_size) : double(set);
    if (bytes <= allowed) return;
    throw Error(fmt::format("{}: asks for {} of memory, more than {}", display_name(path), megabytes(bytes),
                            set == by_size ? "is usual for a file of its size: give `max_memory` to allow it"
                                           : "`max_memory` allows"));
}

} // namespace sparselens
