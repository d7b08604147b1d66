// Pictures as OpenEXR reads and writes them, for the scripts that test the tools. It uses none of the project's own
// reading and writing, so that a fault there shows.
#pragma once

#include <ImfHeader.h>
#include <ImfPixelType.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pictures {

// A channel in double, which holds each half, float and uint exactly.
struct Channel {
    std::string name;
    Imf::PixelType type = Imf::FLOAT;
    std::vector<double> values = {}; // of the samples, pixel by pixel
};

// One part, flat or deep. Rows of the data window from the top, pixels from the left.
struct Picture {
    Imf::Header header; // the windows and the attributes; its channels do not count
    bool deep = false;
    std::vector<std::uint32_t> samples = {}; // per pixel: 1, unless deep
    std::vector<Channel> channels = {};

    Imath::Box2i window() const { return header.dataWindow(); }
    int width() const { return window().max.x - window().min.x + 1; }
    int height() const { return window().max.y - window().min.y + 1; }

    // Throws std::runtime_error if there is none.
    const Channel &channel(const std::string &name) const;
};

// Reads a file of one part. Throws std::exception that names the file if it cannot be read.
Picture read(const std::string &file);

// Writes a flat picture. Throws in the same way.
void write(const Picture &picture, const std::string &file);

} // namespace pictures
