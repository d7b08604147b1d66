#include "measure/regions.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// lower_envelope: result[p] = min over q of f[q] + (spacing (p - q))^2, in linear time. If f[q] = -r^2, a result <= 0
// says that p lies within r of some q, whatever the sizes of the discs.
// P. Felzenszwalb, D. Huttenlocher, "Distance transforms of sampled functions", 2012.
struct Envelope {
    std::vector<std::size_t> vertex; // the parabolas of the envelope, from the left
    std::vector<double> start;       // where each begins to be the lowest one

    void add(std::span<const double> f, std::size_t q, double spacing) {
        if (f[q] == infinity) return;
        double from = -infinity;
        while (!vertex.empty()) {
            const std::size_t v = vertex.back();
            const double xq = spacing * double(q), xv = spacing * double(v);
            from = ((f[q] + xq * xq) - (f[v] + xv * xv)) / (2 * (xq - xv));
            if (from > start.back()) break;
            vertex.pop_back();
            start.pop_back();
        }
        start.push_back(vertex.empty() ? -infinity : from);
        vertex.push_back(q);
    }
};

void lower_envelope(std::span<const double> f, double spacing, std::span<double> result) {
    Envelope envelope;
    for (std::size_t q = 0; q < f.size(); ++q) envelope.add(f, q, spacing);
    if (envelope.vertex.empty()) {
        std::fill(result.begin(), result.end(), infinity);
        return;
    }
    std::size_t k = 0;
    for (std::size_t p = 0; p < f.size(); ++p) {
        const double x = spacing * double(p);
        while (k + 1 < envelope.vertex.size() && envelope.start[k + 1] <= x) ++k;
        const double distance = x - spacing * double(envelope.vertex[k]);
        result[p] = f[envelope.vertex[k]] + distance * distance;
    }
}

// -r^2 at both pixels of each jump, where r is their reach; infinity elsewhere.
std::vector<double> jumps(std::span<const float> c, const ArrayGrid &grid, double pixel_aspect) {
    // A disc that covers the picture is large enough; larger ones would only cost precision.
    const double largest = grid.width() + grid.height() / pixel_aspect;
    std::vector<double> reach(c.size(), infinity);
    const auto mark = [&](std::size_t i, std::size_t j) {
        if (!(std::abs(double(c[i]) - double(c[j])) > 1)) return;
        const double local = std::max({std::abs(double(c[i])), std::abs(double(c[j])), 1.0});
        const double r = std::min(local, largest);
        reach[i] = std::min(reach[i], -r * r);
        reach[j] = std::min(reach[j], -r * r);
    };
    for (int y = 0; y < grid.height(); ++y)
        for (int x = 0; x < grid.width(); ++x) {
            if (x + 1 < grid.width()) mark(grid.index(Position(x, y)), grid.index(Position(x + 1, y)));
            if (y + 1 < grid.height()) mark(grid.index(Position(x, y)), grid.index(Position(x, y + 1)));
        }
    return reach;
}

// The discs around the jumps: values <= 0 lie inside.
std::vector<double> grown_jumps(std::span<const float> c, const ArrayGrid &grid, double pixel_aspect) {
    std::vector<double> field = jumps(c, grid, pixel_aspect);
    const std::size_t width = std::size_t(grid.width()), height = std::size_t(grid.height());
    parallel_for(height, [&](std::size_t y) {
        const std::span row = std::span(field).subspan(grid.index(Position(0, int(y))), width);
        const std::vector<double> before(row.begin(), row.end());
        lower_envelope(before, 1, row);
    });
    parallel_for(width, [&](std::size_t x) {
        std::vector<double> before(height), after(height);
        for (std::size_t y = 0; y < height; ++y) before[y] = field[grid.index(Position(int(x), int(y)))];
        lower_envelope(before, 1 / pixel_aspect, after);
        for (std::size_t y = 0; y < height; ++y) field[grid.index(Position(int(x), int(y)))] = after[y];
    });
    return field;
}

} // namespace

std::vector<std::uint8_t> region_bits(std::span<const float> c, int width, int height, double pixel_aspect) {
    const std::vector<double> silhouettes = grown_jumps(c, ArrayGrid(width, height), pixel_aspect);
    std::vector<std::uint8_t> bits(c.size());
    for (std::size_t i = 0; i < c.size(); ++i) {
        const float size = std::abs(c[i]);
        bits[i] = std::uint8_t((size < 1 ? in_focus_bit : 0) | (size > 8 ? blurred_bit : 0) |
                               (silhouettes[i] <= 0 ? silhouettes_bit : 0));
    }
    return bits;
}

std::vector<std::uint8_t> bits_over(std::span<const std::uint8_t> bits, const Windows &from,
                                    const Windows &target) {
    std::vector<std::uint8_t> result(target.pixels());
    const Imath::V2i shift = from.display.min - target.display.min;
    std::size_t i = 0;
    for (int y = target.data.min.y; y <= target.data.max.y; ++y)
        for (int x = target.data.min.x; x <= target.data.max.x; ++x, ++i) {
            const Imath::V2i p = Imath::V2i(x, y) + shift;
            if (!from.data.intersects(p)) continue;
            result[i] = bits[from.index(p)];
        }
    return result;
}

} // namespace sparselens
