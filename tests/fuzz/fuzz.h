// Shared by the fuzz targets. Each target is a function that accepts any bytes. libFuzzer calls it (tests/fuzz.sh), and
// as part of the tests replay.cpp, with a kept corpus and simple mutations of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size);

namespace sparselens::fuzz {

inline std::string_view text_of(const std::uint8_t *data, std::size_t size) {
    return {reinterpret_cast<const char *>(data), size};
}

// An exception is a valid answer; crashing, hanging and exhausting memory are not.
template <typename Work>
void may_fail(const Work &work) {
    try {
        work();
    } catch (const std::exception &) {
    }
}

} // namespace sparselens::fuzz
