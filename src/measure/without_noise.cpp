#include "measure/without_noise.h"

#include "base/light.h"
#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sparselens {

namespace {

constexpr std::size_t colours = 3, rgba = 4;

// Sums over pixels: first in rows, then over rows in order, so that they are the same on any number of threads.
struct Sums {
    double products = 0, squared_noise = 0;
    std::size_t pixels = 0;

    void add(const Sums &other) {
        products += other.products;
        squared_noise += other.squared_noise;
        pixels += other.pixels;
    }
};

Sums sums_of(const std::array<const Image *, 3> &pictures, std::size_t i) {
    Sums sums;
    double noise = 0;
    for (std::size_t c = 0; c < rgba; ++c) {
        std::array<double, 3> value{};
        for (std::size_t k = 0; k < 3; ++k) {
            const float v = pictures[k]->plane(c)[i];
            if (!std::isfinite(v)) return {};
            value[k] = tone_mapped(double(v));
        }
        if (c == colours) break; // coverage only has to be finite
        const auto [p, a, b] = value;
        sums.products += (p - a) * (p - b);
        noise += (a - b) * (a - b) / 2;
    }
    sums.squared_noise = noise * noise / 3; // E n^4 = 3 (E n^2)^2
    sums.pixels = 1;
    return sums;
}

} // namespace

double ErrorWithoutNoise::decibels() const { return -10 * std::log10(mean_square); }

bool ErrorWithoutNoise::is_told() const { return mean_square > 2 * deviation; }

double ErrorWithoutNoise::at_least() const {
    return -10 * std::log10(std::max(mean_square, 0.0) + 2 * deviation);
}

std::vector<ErrorWithoutNoise> error_without_noise(const Image &image, const Image &first,
                                                   const Image &second,
                                                   std::span<const std::uint8_t> region_bits,
                                                   std::size_t regions) {
    const auto width = std::size_t(image.windows.width()), height = std::size_t(image.windows.height());
    std::vector<std::vector<Sums>> rows(height, std::vector<Sums>(regions + 1));
    parallel_for(height, [&](std::size_t row) {
        for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
            const Sums sums = sums_of({&image, &first, &second}, i);
            rows[row][0].add(sums);
            for (std::size_t r = 0; r < regions; ++r)
                if (region_bits[i] >> r & 1) rows[row][r + 1].add(sums);
        }
    });
    std::vector<ErrorWithoutNoise> errors;
    for (std::size_t r = 0; r <= regions; ++r) {
        Sums all;
        for (const auto &row : rows) all.add(row[r]);
        const double values = double(colours * all.pixels);
        errors.push_back({all.products / values, std::sqrt(all.squared_noise) / values});
    }
    return errors;
}

Image mean_of_references(const Image &first, const Image &second) {
    Image mean = first;
    for (std::size_t i = 0; i < mean.values.size(); ++i)
        mean.values[i] = (first.values[i] + second.values[i]) / 2;
    return mean;
}

} // namespace sparselens
