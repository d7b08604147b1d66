// What the fuzz targets share. Each is a function that may be given any bytes; libFuzzer calls it (tests/fuzz.sh), and
// replay.cpp with a kept corpus and simple mutations of it, as part of the tests.
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

// Failing is an answer; crashing, hanging and taking memory are not.
template <typename Work>
void may_fail(const Work &work) {
    try {
        work();
    } catch (const std::exception &) {
    }
}

} // namespace sparselens::fuzz
