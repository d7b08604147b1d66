#include "io/files/memory_limit.h"

#include "base/error.h"
#include "io/files/file_stream.h"

#include <atomic>
#include <cmath>

namespace sparselens {

namespace {

constexpr double base_bytes = 64.0 * 1024 * 1024, bytes_per_byte = 1100;
constexpr std::uint64_t by_size = 0;

std::atomic<std::uint64_t> process_limit = by_size;

std::string megabytes(double bytes) {
    return std::to_string(std::llround(std::ceil(bytes / (1024 * 1024)))) + " MB";
}

} // namespace

void set_memory_limit(std::optional<std::uint64_t> bytes) { process_limit = bytes.value_or(by_size); }

void check_memory(const std::string &path, double bytes, std::uint64_t file_size) {
    const std::uint64_t set = process_limit;
    const double allowed = set == by_size ? base_bytes + bytes_per_byte * double(file_size) : double(set);
    if (bytes <= allowed) return;
    throw Error(display_name(path) + ": asks for " + megabytes(bytes) + " of memory, more than " +
                (set == by_size ? "a file of its size may; --max-memory allows it" : "--max-memory allows"));
}

} // namespace sparselens
