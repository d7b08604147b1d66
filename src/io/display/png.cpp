#include "io/display/png.h"

#include "base/error.h"

#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace sparselens {

namespace {

using Bytes = std::vector<std::uint8_t>;

std::uint8_t eight_bits(float value) {
    if (!(value > 0)) return 0; // NaN too
    return value >= 1 ? 255 : std::uint8_t(std::lround(value * 255));
}

void add_number(Bytes &bytes, std::uint32_t value) {
    for (const int shift : {24, 16, 8, 0}) bytes.push_back(std::uint8_t(value >> shift));
}

// Length, type, data, CRC of type and data.
void add_chunk(Bytes &file, const char *type, const Bytes &data) {
    add_number(file, std::uint32_t(data.size()));
    const std::size_t checked = file.size();
    file.insert(file.end(), type, type + 4);
    file.insert(file.end(), data.begin(), data.end());
    add_number(file, std::uint32_t(crc32(0, file.data() + checked, uInt(file.size() - checked))));
}

Bytes header(std::size_t width, std::size_t height) {
    Bytes data;
    add_number(data, std::uint32_t(width));
    add_number(data, std::uint32_t(height));
    data.insert(data.end(), {8, 2, 0, 0, 0}); // bits, RGB, deflate, the filters of the standard, no interlace
    return data;
}

// Of left, upper and upper left neighbour the one nearest to left + upper - upper left.
std::uint8_t paeth(int left, int up, int corner) {
    const int guess = left + up - corner;
    const int to_left = std::abs(guess - left), to_up = std::abs(guess - up),
              to_corner = std::abs(guess - corner);
    if (to_left <= to_up && to_left <= to_corner) return std::uint8_t(left);
    return std::uint8_t(to_up <= to_corner ? up : corner);
}

// Each row a filter type (4, Paeth), then its bytes less what their neighbours let expect.
Bytes filtered(const Bytes &rgb, std::size_t width, std::size_t height) {
    const std::size_t stride = 3 * width;
    Bytes data;
    data.reserve((stride + 1) * height);
    for (std::size_t y = 0; y < height; ++y) {
        data.push_back(4);
        const auto at = [&](std::size_t rows_up, std::size_t i) -> int { // i: 3 beyond the byte to its left
            return y < rows_up || i < 3 ? 0 : rgb[(y - rows_up) * stride + i - 3];
        };
        for (std::size_t i = 3; i < stride + 3; ++i)
            data.push_back(std::uint8_t(at(0, i) - paeth(at(0, i - 3), at(1, i), at(1, i - 3))));
    }
    return data;
}

Bytes deflated(const Bytes &data) {
    uLongf size = compressBound(uLong(data.size()));
    Bytes result(size);
    if (compress2(result.data(), &size, data.data(), uLong(data.size()), 6) != Z_OK)
        throw Error("PNG: cannot be compressed");
    result.resize(size);
    return result;
}

} // namespace

std::string png_of(const Image &image) {
    const auto width = std::size_t(image.windows.width()), height = std::size_t(image.windows.height());
    Bytes rgb(3 * width * height);
    for (std::size_t channel = 0; channel < 3; ++channel)
        for (std::size_t i = 0; i < width * height; ++i)
            rgb[3 * i + channel] = eight_bits(image.plane(channel)[i]);
    Bytes file{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    add_chunk(file, "IHDR", header(width, height));
    add_chunk(file, "sRGB", {0}); // values are as a screen shows them
    add_chunk(file, "IDAT", deflated(filtered(rgb, width, height)));
    add_chunk(file, "IEND", {});
    return {file.begin(), file.end()};
}

} // namespace sparselens
