// What the fuzz targets share. Each is a function that may be given any bytes; libFuzzer calls it (tests/fuzz.sh), and
// replay.cpp with a kept corpus and simple mutations of it, as part of the tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size);

namespace sparselens::fuzz {

// A file in memory, gone with the object; its path can be opened as any other's.
class MemoryFile {
public:
    MemoryFile(const std::uint8_t *data, std::size_t size);
    ~MemoryFile();
    MemoryFile(const MemoryFile &) = delete;
    MemoryFile &operator=(const MemoryFile &) = delete;

    std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

private:
    int descriptor_;
};

// Failing is an answer; crashing, hanging and taking memory are not.
template <typename Work>
void may_fail(const Work &work) {
    try {
        work();
    } catch (const std::exception &) {
    }
}

} // namespace sparselens::fuzz
