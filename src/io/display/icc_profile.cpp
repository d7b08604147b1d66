#include "io/display/icc_profile.h"

#include <Imath/ImathMatrix.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sparselens {

namespace {

constexpr std::size_t head = 128; // bytes before the table of tags

// A number of big-endian bytes; 0 beyond the end.
std::uint32_t number(std::string_view bytes, std::size_t at, std::size_t size = 4) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + size && at + size <= bytes.size(); ++i)
        value = value << 8 | std::uint8_t(bytes[i]);
    return value;
}

double fixed(std::string_view bytes, std::size_t at) { return std::int32_t(number(bytes, at)) / 65536.0; }

// The bytes of a tag; empty if there is none.
std::string_view tag(std::string_view profile, std::string_view name) {
    const std::size_t count = std::min<std::size_t>(number(profile, head), profile.size() / 12);
    for (std::size_t at = head + 4; at < head + 4 + 12 * count && at + 12 <= profile.size(); at += 12)
        if (profile.substr(at, 4) == name && number(profile, at + 4) <= profile.size())
            return profile.substr(number(profile, at + 4), number(profile, at + 8));
    return {};
}

// parametricCurveType: a power, and below `d` a line.
double parametric(std::string_view curve, double v) {
    const std::uint32_t kind = number(curve, 8, 2);
    const auto p = [&](std::size_t i) { return fixed(curve, 12 + 4 * i); };
    const double g = p(0), a = kind > 0 ? p(1) : 1, b = kind > 0 ? p(2) : 0;
    const double line = kind > 2 ? p(3) : 0, c = kind == 2 ? p(3) : 0;
    const double d = kind > 2 ? p(4) : kind > 0 ? -b / a : 0;
    const double e = kind == 4 ? p(5) : c, f = kind == 4 ? p(6) : c;
    return v >= d ? std::pow(std::max(a * v + b, 0.0), g) + e : line * v + f;
}

// curveType: a power, or values between 0 and 1 with lines between them.
double listed(std::string_view curve, double v) {
    const std::uint32_t count = number(curve, 8);
    if (count == 0) return v;
    if (count == 1) return std::pow(v, number(curve, 12, 2) / 256.0);
    const double at = v * (count - 1);
    const auto low = std::min(std::size_t(at), std::size_t(count) - 2);
    const auto entry = [&](std::size_t i) { return number(curve, 12 + 2 * i, 2) / 65535.0; };
    return entry(low) + (at - double(low)) * (entry(low + 1) - entry(low));
}

// The linear values of 0 to 1 in equal steps; empty for no such curve, and one that does not rise.
std::vector<float> table_of(std::string_view curve) {
    constexpr std::size_t steps = 65535; // every value of 16 bits
    if (!curve.starts_with("para") && !curve.starts_with("curv")) return {};
    std::vector<float> values;
    for (std::size_t i = 0; i <= steps; ++i) {
        const double v = double(i) / steps;
        values.push_back(float(curve[0] == 'p' ? parametric(curve, v) : listed(curve, v)));
    }
    const bool rises =
        std::ranges::is_sorted(values) && values.back() > values.front() && std::isfinite(values.back());
    return rises ? values : std::vector<float>();
}

} // namespace

bool is_rgb_profile(std::string_view bytes) {
    return bytes.size() > head && bytes.substr(16, 4) == "RGB " && bytes.substr(36, 4) == "acsp" &&
           number(bytes, 0) == bytes.size();
}

std::optional<ColourTransform> transform_of_profile(const std::string &bytes, ProfileDirection direction) {
    if (!is_rgb_profile(bytes)) return {};
    CurvesAndMatrix made;
    Imath::M33d primaries; // a row for each of R, G and B: its X, Y and Z beside D50
    for (std::size_t k = 0; k < 3; ++k) {
        const std::string colour(1, "rgb"[k]);
        made.curves[k] = table_of(tag(bytes, colour + "TRC"));
        const std::string_view xyz = tag(bytes, colour + "XYZ");
        if (made.curves[k].empty() || !xyz.starts_with("XYZ ")) return {};
        for (std::size_t i = 0; i < 3; ++i) primaries[int(k)][int(i)] = fixed(xyz, 8 + 4 * i);
    }
    // From X, Y and Z beside D50 to linear Rec.709, its white adapted by Bradford.
    const Imath::M33d to_rec709(3.1338561, -0.9787684, 0.0719453, -1.6168667, 1.9161415, -0.2289914,
                                -0.4906146, 0.0334540, 1.4052427);
    if (std::abs(primaries.determinant()) < 1e-6) return {};
    made.matrix = primaries * to_rec709;
    return ColourTransform::of(made, direction == ProfileDirection::from_linear);
}

} // namespace sparselens
