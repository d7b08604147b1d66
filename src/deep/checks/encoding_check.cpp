#include "deep/checks/picture_checks.h"
#include "deep/checks/picture_lines.h"
#include "view/flat_pixels.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

constexpr double explained = 0.1;        // of the pixels
constexpr double sure = 3;               // standard deviations
constexpr double around = 0.5;           // of the way from the line to the curve
constexpr double contrast = 0.15;        // of the sides, relative to their sum
constexpr double even = 0.1;             // change within a side, of the contrast
constexpr double clearly_mixed = 0.15;   // share of either side, at least
constexpr double least_departure = 0.01; // of the curve from the line, relative to the contrast

// sRGB.
Imath::V3d decoded(const Imath::V3d &v) {
    const auto one = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
    return {one(v.x), one(v.y), one(v.z)};
}
Imath::V3d encoded(const Imath::V3d &v) {
    const auto one = [](double c) {
        return c <= 0.0031308 ? c * 12.92 : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
    };
    return {one(v.x), one(v.y), one(v.z)};
}

// The point at `along` on the way from a to b for a mixture of light that is encoded afterwards.
Imath::V3d on_curve(const Imath::V3d &a, const Imath::V3d &b, double along) {
    const Imath::V3d light_a = decoded(a), light_b = decoded(b), way = b - a;
    double low = 0, high = 1;
    Imath::V3d at = a;
    for (int i = 0; i < 12; ++i) { // far finer than the check needs
        const double share = (low + high) / 2;
        at = encoded(light_a * (1 - share) + light_b * share);
        ((at - a).dot(way) < along * way.length2() ? low : high) = share;
    }
    return at;
}

// Counts a pixel between two sides.
void ask(const Imath::V3d &a, const Imath::V3d &pixel, const Imath::V3d &b, EdgeMixing &mixing) {
    const Imath::V3d way = b - a;
    const double along = (pixel - a).dot(way) / way.length2();
    if (along < clearly_mixed || along > 1 - clearly_mixed) return;
    const Imath::V3d on_line = a + way * along;
    const Imath::V3d departure = on_curve(a, b, along) - on_line;
    if (departure.length() < least_departure * way.length()) return;
    const auto is_at = [&](double place) {
        return (pixel - on_line - departure * place).length() < around * departure.length();
    };
    ++mixing.pixels;
    mixing.light += is_at(0);
    mixing.encoded += is_at(1);
    mixing.beyond += is_at(2);
}

// Whether the count `a` exceeds `b` by more than chance.
bool surely_more(std::size_t a, std::size_t b) {
    return double(a) - double(b) > sure * std::sqrt(double(a + b));
}

bool is_displayable(const Imath::V3d &v) {
    return std::min({v.x, v.y, v.z}) >= 0 && std::max({v.x, v.y, v.z}) <= 1;
}

} // namespace

EdgeMixing mixing_at_edges(const View &view) {
    const FlatPixels pixels = flat_pixels(view);
    if (!pixels.have_colours()) return {};
    const auto colour = [&](std::size_t i) { return pixels.colour(i); };
    EdgeMixing mixing;
    visit_lines(pixels.grid, [&](const PictureLine &line) {
        for (std::size_t i = 2; i + 2 < line.length; ++i) {
            const Imath::V3d a = colour(line[i - 1]), b = colour(line[i + 1]);
            const double apart = (b - a).length();
            if (!(apart > contrast * (a + b).length())) continue;
            if (!is_displayable(a) || !is_displayable(b)) continue;
            if ((colour(line[i - 2]) - a).length() > even * apart) continue;
            if ((colour(line[i + 2]) - b).length() > even * apart) continue;
            ask(a, colour(line[i]), b, mixing);
        }
    });
    return mixing;
}

bool looks_encoded(const EdgeMixing &mixing) {
    return double(mixing.encoded) >= explained * double(mixing.pixels) &&
           surely_more(mixing.encoded, mixing.light) && surely_more(mixing.encoded, mixing.beyond);
}

} // namespace sparselens
