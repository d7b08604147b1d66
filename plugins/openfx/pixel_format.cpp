#include "pixel_format.h"

#include "ofx.h"

#define IMATH_HALF_NO_LOOKUP_TABLE // so that nothing of Imath is linked
#include <Imath/half.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace sparselens_ofx {

namespace {

// memcpy: rows of a host need not be aligned.
template <typename From, typename To, typename Convert>
void convert_all(const void *from, int count, void *to, const Convert &convert) {
    for (std::size_t i = 0; i < std::size_t(count); ++i) {
        From one;
        std::memcpy(&one, static_cast<const char *>(from) + i * sizeof one, sizeof one);
        const To converted = convert(one);
        std::memcpy(static_cast<char *>(to) + i * sizeof converted, &converted, sizeof converted);
    }
}

template <typename Whole>
Whole rounded(float value) {
    constexpr float most = float(Whole(-1));
    // A value that is no number becomes 0.
    return Whole(std::lround(std::min(std::max(0.0f, value), 1.0f) * most));
}

} // namespace

std::size_t PixelFormat::bytes() const {
    const std::size_t each = depth == Depth::byte ? 1 : depth == Depth::full ? 4 : 2;
    return each * std::size_t(components);
}

std::optional<PixelFormat> pixel_format(const std::string &depth, const std::string &components) {
    PixelFormat format;
    if (depth == kOfxBitDepthByte)
        format.depth = Depth::byte;
    else if (depth == kOfxBitDepthShort)
        format.depth = Depth::whole_short;
    else if (depth == kOfxBitDepthHalf)
        format.depth = Depth::half;
    else if (depth != kOfxBitDepthFloat)
        return {};
    if (components == kOfxImageComponentRGB)
        format.components = 3;
    else if (components == kOfxImageComponentAlpha)
        format.components = 1;
    else if (components != kOfxImageComponentRGBA)
        return {};
    return format;
}

void read_pixel(const PixelFormat &format, const void *from, float *to) {
    const int count = format.components;
    switch (format.depth) {
    case Depth::byte:
        return convert_all<std::uint8_t, float>(from, count, to, [](auto v) { return float(v) / 255; });
    case Depth::whole_short:
        return convert_all<std::uint16_t, float>(from, count, to, [](auto v) { return float(v) / 65535; });
    case Depth::half: return convert_all<std::uint16_t, float>(from, count, to, imath_half_to_float);
    case Depth::full: std::memcpy(to, from, format.bytes());
    }
}

void write_pixel(const PixelFormat &format, const float *from, void *to) {
    const int count = format.components;
    switch (format.depth) {
    case Depth::byte: return convert_all<float, std::uint8_t>(from, count, to, rounded<std::uint8_t>);
    case Depth::whole_short:
        return convert_all<float, std::uint16_t>(from, count, to, rounded<std::uint16_t>);
    case Depth::half: return convert_all<float, std::uint16_t>(from, count, to, imath_float_to_half);
    case Depth::full: std::memcpy(to, from, format.bytes());
    }
}

} // namespace sparselens_ofx
