// The pixels of a host, as 32-bit floats: bytes, shorts, halves or floats, with 4, 3 or 1 components.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace sparselens_ofx {

enum class Depth { byte, whole_short, half, full };

struct PixelFormat {
    Depth depth = Depth::full;
    int components = 4; // R, G, B, A; R, G, B; or one alone

    std::size_t bytes() const; // of a pixel
    // Whole numbers hold colours for a screen, as in a PNG; floating ones hold light.
    bool is_whole() const { return depth == Depth::byte || depth == Depth::whole_short; }
};

// By the names of OpenFX (kOfxBitDepthByte, kOfxImageComponentRGBA). Empty if there is no such format here.
std::optional<PixelFormat> pixel_format(const std::string &depth, const std::string &components);

// Whole numbers stand for 0 to 1; values beyond are cut, others rounded to the nearest one.
void read_pixel(const PixelFormat &format, const void *from, float *components);
void write_pixel(const PixelFormat &format, const float *components, void *to);

} // namespace sparselens_ofx
