#include "lab/trace/materials.h"

#include <cmath>
#include <cstdint>

namespace sparselens::lab {

namespace {

int cell(double scale, double coordinate) { return int(std::floor(scale * coordinate)); }

bool odd(int n) { return (n & 1) != 0; }

} // namespace

double hash(int a, int b, int c) {
    std::uint32_t h =
        std::uint32_t(a) * 73856093u ^ std::uint32_t(b) * 19349663u ^ std::uint32_t(c) * 83492791u;
    h ^= h >> 13;
    h *= 0x5bd1e995u;
    h ^= h >> 15;
    return (h & 0xffffffu) * 0x1p-24;
}

Paint floor_tiles(const Imath::V3d &p) {
    const int a = cell(2, p.x), c = cell(2, p.z);
    if (odd(a + c)) return {{0.8f, 0.75f, 0.7f}};
    return {{float(0.15 + 0.2 * hash(a, 0, c)), 0.2f, 0.25f}};
}

Paint wall_tiles(const Imath::V3d &p) {
    const int a = cell(4, p.x), b = cell(4, p.y);
    if (odd(a + b)) return {{0.2f, float(0.5 * hash(a, b, 7)), 0.7f}};
    return {{0.9f, float(0.6 + 0.3 * hash(a, b, 7)), 0.2f}};
}

Paint dots(const Imath::V3d &p) {
    if (std::sin(40 * p.x) * std::sin(40 * p.y) * std::sin(40 * p.z) > 0) return {{0.9f, 0.2f, 0.15f}};
    return {{0.95f, 0.9f, 0.85f}};
}

Paint stripes(const Imath::V3d &p) {
    if (std::sin(30 * p.y + 10 * p.x) > 0) return {{0.1f, 0.6f, 0.2f}};
    return {{0.6f, 0.8f, 0.3f}};
}

Paint dark(const Imath::V3d &) { return {{0.05f, 0.05f, 0.06f}}; }

Paint lamp(const Imath::V3d &) { return {{60, 48, 30}, 1, true}; }

Paint even_tiles(const Imath::V3d &p) {
    const int a = cell(40, p.x / p.z), b = cell(40, p.y / p.z);
    if (odd(a + b)) return {{0.8f, 0.75f, 0.7f}};
    return {{float(0.1 + 0.5 * hash(a, b, 0)), float(0.1 + 0.4 * hash(a, b, 1)), 0.3f}};
}

Paint bright_lamp(const Imath::V3d &) { return {{1000, 1000, 1000}, 1, true}; }

Paint night(const Imath::V3d &) { return {{0.02f, 0.02f, 0.025f}, 1, true}; }

Paint chrome(const Imath::V3d &) { return {{0.05f, 0.05f, 0.05f}, 1, false, 0.9f}; }

Paint silver(const Imath::V3d &) { return {{0, 0, 0}, 1, true, 1}; }

Paint brushed(const Imath::V3d &) { return {{0, 0, 0}, 1, true, 1, 0.03f}; }

Paint clear_glass(const Imath::V3d &) { return {{0, 0, 0}, 1, true, 1, 0, float(glass_thickness)}; }

Paint glossy_tiles(const Imath::V3d &p) {
    Paint paint = floor_tiles(p);
    paint.mirror = 0.4f;
    return paint;
}

Paint mosaic(const Imath::V3d &p) {
    const double u = p.x + 0.3 * p.z, v = p.y + 0.2 * p.z;
    const auto tone = [&](double scale, int k) { return hash(cell(scale, u), cell(scale, v), k); };
    return {{float(0.1 + 0.4 * tone(1.3, 1) + 0.4 * tone(4, 2)),
             float(0.1 + 0.4 * tone(1.7, 3) + 0.4 * tone(4, 4)),
             float(0.1 + 0.4 * tone(2.3, 5) + 0.4 * tone(4, 6))}};
}

Paint near_sheet(const Imath::V3d &p) {
    return {{0.9f, 0.5f, 0.3f}, float(0.4 + 0.3 * std::sin(9 * p.x + 4 * p.y)), true};
}

Paint focus_sheet(const Imath::V3d &p) {
    const bool bright = odd(cell(6, p.x) + cell(6, p.y));
    return {bright ? Imath::C3f(0.9f, 0.9f, 0.8f) : Imath::C3f(0.1f, 0.2f, 0.5f), 0.6f, true};
}

Paint far_sheet(const Imath::V3d &p) {
    return {{0.1f, 0.7f, float(0.4 + 0.3 * std::sin(5 * p.y))}, float(0.5 + 0.4 * std::sin(6 * p.x)), true};
}

Paint backdrop(const Imath::V3d &p) {
    Paint paint = wall_tiles(p);
    paint.emits = true;
    return paint;
}

Paint skin(const Imath::V3d &p) {
    const double freckle = std::sin(900 * p.x) * std::sin(900 * p.y) * std::sin(900 * p.z);
    if (freckle > 0.25) return {{0.45f, 0.25f, 0.15f}};
    return {{0.75f, float(0.5 + 0.1 * std::sin(200 * p.x + 150 * p.y)), 0.4f}};
}

Paint head_lamp(const Imath::V3d &) { return {{200, 180, 150}, 1, true}; }

} // namespace sparselens::lab
