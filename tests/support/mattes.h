// Cryptomattes for tests: channels, ids, and the coverage of an id in the pixels of a picture.
#pragma once

#include "base/matte.h"
#include "deep/ldi.h"

#include <bit>
#include <cstdint>
#include <set>
#include <string>

namespace sparselens {

// R, G, B, A and the pairs of a matte "CryptoObject", two in each of `layers`.
inline std::vector<Channel> channels_with_matte(int layers = 1) {
    std::vector<Channel> channels = rgba_channels();
    for (int layer = 0; layer < layers; ++layer)
        for (const char *last : {".R", ".G", ".B", ".A"})
            channels.push_back(
                {"CryptoObject" + std::string(layer < 10 ? "0" : "") + std::to_string(layer) + last,
                 PixelType::float32});
    find_kinds(channels);
    return channels;
}

// A hash as an id: half of them are above 1e34 or denormal, none is infinite or NaN.
inline float hashed(std::uint32_t n) {
    std::uint32_t bits = n * 2654435761u ^ 0x5bd1e995u;
    if (n % 4 == 0) bits = 0x7e000000u | (bits & 0xffffffu); // above 4e37
    if (n % 4 == 1) bits &= 0x807fffffu;                     // denormal
    if ((bits >> 23 & 255) == 255) bits ^= 1u << 23;         // as the specification asks
    return std::bit_cast<float>(bits);
}

// Coverage of an id in pixel i of a picture or sample i of an LDI.
inline double coverage_of(const std::vector<Matte> &mattes, float id, const auto &value) {
    double sum = 0;
    for (const Matte &matte : mattes)
        for (const Matte::Rank &rank : matte.ranks)
            if (std::bit_cast<std::uint32_t>(value(rank.id)) == std::bit_cast<std::uint32_t>(id))
                sum += double(value(rank.coverage));
    return sum;
}

inline double coverage_in(const Image &picture, float id, std::size_t pixel) {
    return coverage_of(find_mattes(picture.channels), id,
                       [&](std::size_t k) { return picture.plane(k)[pixel]; });
}

// The bits of all ids with coverage.
inline std::set<std::uint32_t> ids_in(const std::vector<Channel> &channels, std::size_t count,
                                      const auto &values_of) {
    std::set<std::uint32_t> ids;
    for (const Matte &matte : find_mattes(channels))
        for (const Matte::Rank &rank : matte.ranks)
            for (std::size_t i = 0; i < count; ++i)
                if (values_of(rank.coverage)[i] > 0)
                    ids.insert(std::bit_cast<std::uint32_t>(values_of(rank.id)[i]));
    return ids;
}

inline std::set<std::uint32_t> ids_in(const Ldi &ldi) {
    return ids_in(
        ldi.channels, ldi.samples(), [&](std::size_t k) -> const auto & { return ldi.values[k]; });
}

inline std::set<std::uint32_t> ids_in(const Image &picture) {
    return ids_in(picture.channels, picture.windows.pixels(),
                  [&](std::size_t k) { return picture.plane(k); });
}

} // namespace sparselens
