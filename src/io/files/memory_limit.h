// How much memory a file may ask for: a few bytes of header can claim a picture of terabytes, so readers ask here
// before they allocate.
//
// Without another limit that is 64 MB and 1100 times the file's size: deflate, the densest of EXR's compressions
// that keep all bits, packs at most 1032 bytes into one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace sparselens {

// For the whole process, before anything is read; empty: by each file's size.
void set_memory_limit(std::optional<std::uint64_t> bytes);

// Error, naming the file and --max-memory, where `bytes` are more than a file of that size may ask for. `bytes` is a
// double because what a header claims may overflow any integer.
void check_memory(const std::string &path, double bytes, std::uint64_t file_size);

} // namespace sparselens
