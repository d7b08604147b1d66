#include "match/pictures.h"

#include "base/parallel.h"
#include "base/tone_map.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace sparselens {

namespace {

// The weights of a Gaussian from its middle outwards; their sum over both sides is 1. Its variance is exact also if it
// is smaller than a pixel, or negative, which sharpens.
std::vector<float> gaussian(double variance) {
    if (variance < 0.5) // the weights of three pixels
        return {float(1 - variance), float(variance / 2)};
    const int reach = int(std::ceil(3.5 * std::sqrt(variance)));
    std::vector<double> weights;
    double sum = 0;
    for (int i = 0; i <= reach; ++i) {
        weights.push_back(std::exp(-0.5 * i * i / variance));
        sum += (i == 0 ? 1 : 2) * weights.back();
    }
    std::vector<float> result;
    for (const double w : weights) result.push_back(float(w / sum));
    return result;
}

// `values` has `width` pixels in each row.
std::vector<float> softened(const std::vector<float> &values, int width, std::span<const float> weights) {
    const int reach = int(weights.size()) - 1, height = int(values.size()) / width;
    std::vector<float> across(values.size()), result(values.size());
    const auto blurred = [&](const auto &value, int at, int size) {
        float sum = weights[0] * value(at);
        for (int i = 1; i <= reach; ++i)
            sum += weights[std::size_t(i)] * (value(std::max(at - i, 0)) + value(std::min(at + i, size - 1)));
        return sum;
    };
    const auto row = [&](auto &of, int y) { return of.data() + std::size_t(y) * std::size_t(width); };
    parallel_for(std::size_t(height), [&](std::size_t y) {
        const float *from = row(values, int(y));
        float *to = row(across, int(y));
        for (int x = 0; x < width; ++x) to[x] = blurred([&](int i) { return from[i]; }, x, width);
    });
    parallel_for(std::size_t(height), [&](std::size_t y) {
        float *to = row(result, int(y));
        for (int x = 0; x < width; ++x)
            to[x] = blurred([&](int i) { return row(across, i)[x]; }, int(y), height);
    });
    return result;
}

} // namespace

Rgb softened(const Rgb &linear, double variance) {
    if (variance == 0) return linear;
    const std::vector<float> weights = gaussian(variance);
    Rgb result{linear.grid, {}};
    for (std::size_t k = 0; k < 3; ++k) result.rgb[k] = softened(linear.rgb[k], linear.grid.width(), weights);
    return result;
}

Rgb tone_mapped(Rgb linear) {
    for (std::vector<float> &plane : linear.rgb)
        parallel_ranges(plane.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) plane[i] = float(tone_mapped(double(plane[i])));
        });
    return linear;
}

Grey brightness(const Rgb &of) {
    Grey result{of.grid, std::vector<float>(of.rgb[0].size())};
    for (std::size_t i = 0; i < result.values.size(); ++i)
        result.values[i] = (of.rgb[0][i] + of.rgb[1][i] + of.rgb[2][i]) / 3;
    return result;
}

Rgb difference(Rgb a, const Rgb &b, double step) {
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < a.rgb[k].size(); ++i)
            a.rgb[k][i] = float((double(a.rgb[k][i]) - double(b.rgb[k][i])) / step);
    return a;
}

Rgb black(const Grid &grid) {
    const std::vector<float> plane(grid.size());
    return {grid, {plane, plane, plane}};
}

std::pair<Rgb, Rgb> motion_changes(const Rgb &of) {
    Rgb along = black(of.grid), across = along;
    const Imath::Box2i box = of.grid.box();
    for (std::size_t k = 0; k < 3; ++k)
        for (int y = box.min.y; y <= box.max.y; ++y)
            for (int x = box.min.x; x <= box.max.x; ++x) {
                const auto at = [&](int dx, int dy) {
                    return of.rgb[k][of.grid.index(std::clamp(x + dx, box.min.x, box.max.x),
                                                   std::clamp(y + dy, box.min.y, box.max.y))];
                };
                const std::size_t i = of.grid.index(x, y);
                along.rgb[k][i] = (at(1, 0) + at(-1, 0) - at(0, 1) - at(0, -1)) / 4;
                across.rgb[k][i] = (at(1, 1) + at(-1, -1) - at(1, -1) - at(-1, 1)) / 8;
            }
    return {std::move(along), std::move(across)};
}

} // namespace sparselens
