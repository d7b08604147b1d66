// Pictures with channels of all kinds.
#pragma once

#include "base/image.h"
#include "base/numbers.h"

#include <bit>
#include <functional>
#include <vector>

namespace sparselens {

inline Windows windows_of(const Imath::Box2i &display, const Imath::Box2i &data) {
    return {display, data, 1};
}

// Colours, coverage, data, ids of two kinds and a matte.
inline std::vector<Channel> all_channels() {
    std::vector<Channel> channels{{"R"}, {"A"}, {"N.X"}, {"N.Y"}, {"id", PixelType::uint32}, {"IndexOB"}};
    for (const char *name : {"CryptoObject00.R", "CryptoObject00.G", "CryptoObject00.B", "CryptoObject00.A"})
        channels.push_back({name, PixelType::float32});
    find_kinds(channels);
    return channels;
}

inline Image filled(const Windows &windows, const std::vector<Channel> &channels,
                    const std::function<float(std::size_t k, int x, int y)> &value) {
    Image image(windows, channels);
    const Imath::Box2i &data = windows.data;
    for (std::size_t k = 0; k < channels.size(); ++k)
        for (int y = data.min.y; y <= data.max.y; ++y)
            for (int x = data.min.x; x <= data.max.x; ++x) image.at(k, x, y) = value(k, x, y);
    return image;
}

// Random values; ids are whole numbers from a small range.
inline Image random_picture(const Windows &windows) {
    std::vector<Channel> channels = all_channels();
    return filled(windows, channels, [&](std::size_t k, int x, int y) {
        const std::uint32_t bits = mix_bits(std::uint32_t(k), mix_bits(std::uint32_t(x), std::uint32_t(y)));
        const float share = float(bits >> 8) / 0x1p24f;
        if (channels[k].kind == ChannelKind::matte_id) return float(1 + bits % 3);
        if (channels[k].kind == ChannelKind::matte_coverage) return share / 2;
        return holds_ids(channels[k]) ? std::bit_cast<float>(bits % 5) : share;
    });
}

} // namespace sparselens
