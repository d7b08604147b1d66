// ICC profiles of three primaries and a curve, byte by byte.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

namespace sparselens {

inline std::string big(std::uint32_t value, int bytes = 4) {
    std::string text;
    for (int i = bytes - 1; i >= 0; --i) text += char(value >> (8 * i));
    return text;
}
inline std::string fixed(double value) {
    return big(std::uint32_t(std::int32_t(std::lround(value * 65536))));
}

using Columns = std::array<std::array<double, 3>, 3>;
// The primaries of Display P3 and sRGB, beside D50, as Apple and HP publish them.
inline constexpr Columns p3{
    {{0.51512, 0.2412, -0.00105}, {0.29198, 0.69225, 0.04189}, {0.1571, 0.06657, 0.78407}}};
inline constexpr Columns srgb{
    {{0.43607, 0.22249, 0.01392}, {0.38515, 0.71687, 0.09708}, {0.14307, 0.06061, 0.71410}}};

// A profile with one curve for all.
inline std::string profile_of(const Columns &columns, const std::string &curve) {
    const auto padded = [](std::string text) { return text.append((4 - text.size() % 4) % 4, '\0'); };
    std::string table = big(6), data;
    for (std::size_t k = 0; k < 6; ++k) {
        std::string body = padded(curve);
        if (k < 3)
            body = "XYZ " + big(0) + fixed(columns[k][0]) + fixed(columns[k][1]) + fixed(columns[k][2]);
        table += std::string(1, "rgb"[k % 3]) + (k < 3 ? "XYZ" : "TRC") +
                 big(std::uint32_t(132 + 72 + data.size())) + big(std::uint32_t(body.size()));
        data += body;
    }
    std::string head =
        big(std::uint32_t(128 + table.size() + data.size())) + std::string(8, '\0') + "mntrRGB XYZ ";
    head.append(36 - head.size(), '\0');
    head += "acsp";
    head.append(128 - head.size(), '\0');
    return head + table + data;
}

inline const std::string srgb_curve = "para" + big(0) + big(3, 2) + big(0, 2) + fixed(2.4) +
                                      fixed(1 / 1.055) + fixed(0.055 / 1.055) + fixed(1 / 12.92) +
                                      fixed(0.04045);

} // namespace sparselens
