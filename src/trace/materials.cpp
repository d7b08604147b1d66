#include "trace/materials.h"

#include <cmath>
#include <cstdint>

namespace sparselens {

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

} // namespace sparselens
