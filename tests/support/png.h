// Reads a PNG file of 8 bits RGB with only the rules of its specification (ISO/IEC 15948) and zlib. Reading with the
// library that wrote the file would prove little about other readers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sparselens {

struct Png {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb; // row by row

    int at(int x, int y, int channel) const { return rgb[std::size_t((y * width + x) * 3 + channel)]; }
};

// Throws std::runtime_error if the file is anything else, a checksum is wrong, or it ends early.
Png read_png(const std::string &file);

} // namespace sparselens
