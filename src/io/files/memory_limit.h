// How much memory a file may ask for. A header of a few bytes can claim a picture of terabytes, so readers check here
// before they allocate.
//
// The default limit is 64 MB plus 1100 times the size of the file: deflate, the densest lossless compression of EXR,
// packs at most 1032 bytes into one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace sparselens {

// The memory of the machine, or what the control groups of the process allow (containers, farms) if that is less.
// `root`: the folder with /proc and /sys.
std::uint64_t memory_of_machine(const std::string &root = {});

// Sets the limit of the process, before anything is read. Empty: the default limit, by the size of each file.
void set_memory_limit(std::optional<std::uint64_t> bytes);

// Throws Error, naming the file and max_memory, if a file of that size may not ask for this many bytes. `bytes` is a
// double because the claim of a header may overflow any integer.
void check_memory(const std::string &path, double bytes, std::uint64_t file_size);

} // namespace sparselens
