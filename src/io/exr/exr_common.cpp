#include "io/exr/exr_common.h"

#include "base/parallel.h"
#include "base/text.h"
#include "io/exr/kept_names.h"

#include <ImfTileDescription.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <half.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>

namespace sparselens {

namespace {

// Attributes that describe how one file stores its pixels; they must not be copied into another file.
bool describes_storage(const std::string &name) {
    static constexpr std::array names{
        "channels",         "chunkCount",    "compression", "dataWindow",
        "deepImageState",   "displayWindow", "lineOrder",   "maxSamplesPerPixel",
        "pixelAspectRatio", "preview",       "tiles",       "type",
        "version"};
    return is_among(names, name) || name == kept_names_attribute;
}

} // namespace

Windows windows_of(const Imf::Header &header) {
    return {header.displayWindow(), header.dataWindow(), header.pixelAspectRatio()};
}

double memory_of(const Imf::Header &header, std::size_t values) {
    const Imath::Box2i &data = header.dataWindow();
    const double width = double(data.max.x) - double(data.min.x) + 1;
    const double height = double(data.max.y) - double(data.min.y) + 1;
    double pixels = width * height;
    if (header.hasTileDescription()) {
        const Imf::TileDescription &tile = header.tileDescription();
        pixels += double(tile.xSize) * double(tile.ySize);
    }
    return pixels * double(values * sizeof(float));
}

std::string first_of(const std::vector<std::string> &names) {
    constexpr std::size_t most = 40; // keeps the line readable
    const std::size_t listed = std::min(most, names.size());
    const std::string list =
        fmt::format("{}", fmt::join(names.begin(), names.begin() + std::ptrdiff_t(listed), ", "));
    return listed == names.size() ? list : fmt::format("{} and {} more", list, names.size() - listed);
}

bool is_position_channel(const std::string &channel) {
    static constexpr std::array names{"Z",          "ZBack",       "ldi.dx",   "ldi.dy",
                                      "ldi.weight", "ldi.optical", "ldi.solid"};
    return is_among(names, channel);
}

Imf::Header output_header(const Windows &windows, std::span<const Channel> channels,
                          const Imf::Header &metadata) {
    Imf::Header header(windows.display, windows.data, windows.pixel_aspect);
    for (auto it = metadata.begin(); it != metadata.end(); ++it)
        if (!describes_storage(it.name())) header.insert(it.name(), it.attribute());
    for (const Channel &channel : channels)
        header.channels().insert(channel.name, Imf::Channel(imf_type(channel.type)));
    return header;
}

Imf::PixelType imf_type(PixelType type) {
    switch (type) {
    case PixelType::half: return Imf::HALF;
    case PixelType::uint32: return Imf::UINT;
    case PixelType::float32: break;
    }
    return Imf::FLOAT;
}

std::size_t bytes_of(PixelType type) { return type == PixelType::half ? 2 : 4; }

namespace {

std::size_t store_halves(const float *from, std::size_t count, char *to) {
    constexpr float largest = 65504, rounded_up = 65520; // from here on a half would be infinite
    std::size_t clamped = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const float value = std::isfinite(from[i]) ? std::clamp(from[i], -largest, largest) : from[i];
        if (std::isfinite(from[i]) && std::abs(from[i]) >= rounded_up) ++clamped;
        const Imath::half rounded(value);
        std::memcpy(to + 2 * i, &rounded, 2);
    }
    return clamped;
}

} // namespace

std::size_t store(PixelType type, const float *from, std::size_t count, char *to) {
    if (count == 0) return 0; // the pointers may be null then
    const std::size_t size = bytes_of(type);
    std::atomic<std::size_t> clamped = 0;
    parallel_ranges(count, 65536, [&](std::size_t begin, std::size_t end) {
        if (type == PixelType::half)
            clamped += store_halves(from + begin, end - begin, to + begin * size);
        else
            std::memcpy(to + begin * size, from + begin,
                        (end - begin) * size); // ids keep their bits, see PixelType
    });
    return clamped;
}

} // namespace sparselens
