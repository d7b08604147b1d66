#include "plan/noise.h"

#include "measure/tone_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sparselens {

namespace {

constexpr int block_size = 8;

// Tone-mapped mean of the colours that the image has.
std::vector<double> brightness(const Image &image) {
    std::vector<double> mean(image.windows.pixels());
    double channels = 0;
    for (const std::size_t channel : find_rgb(image.channels)) {
        if (channel == npos) continue;
        ++channels;
        const auto plane = image.plane(channel);
        for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += tone_mapped(plane[i]);
    }
    for (double &value : mean) value /= std::max(channels, 1.0);
    return mean;
}

// Variance of the noise in the block at (x, y), which lies inside the picture's border; 0 where it is not noise that
// shows.
double block_variance(const std::vector<double> &picture, const Grid &grid, int x, int y) {
    const Grid block(block_size, block_size);
    std::array<double, block_size * block_size> residual;
    for (std::size_t i = 0; i < residual.size(); ++i) {
        const Imath::V2i at = block.pixel(i) + Imath::V2i(x, y);
        const double *p = &picture[grid.index(at.x, at.y)];
        residual[i] = std::abs(*p - (p[-1] + p[1] + p[-grid.width()] + p[grid.width()]) / 4);
    }
    std::ranges::sort(residual);
    constexpr double spread = 1.25;                  // variance of a value less the mean of four others
    const auto quantile = [&](std::size_t quarter) { // between two values
        const std::size_t i = quarter * residual.size() / 4;
        return (residual[i - 1] + residual[i]) / 2;
    };
    const double by_quartile = quantile(1) / 0.3186, by_median = quantile(2) / 0.6745;
    return by_quartile > 0.75 * by_median ? by_median * by_median / spread : 0;
}

} // namespace

double noise_in_lens_picture(const Image &image, std::span<const float> z, const ThinLens &lens,
                             std::optional<double> deviation) {
    const Grid grid(image.windows.width(), image.windows.height());
    const std::vector<double> picture = deviation ? std::vector<double>{} : brightness(image);
    double sum = 0;
    int blocks = 0;
    for (int y = 1; y + block_size < grid.height(); y += block_size)
        for (int x = 1; x + block_size < grid.width(); x += block_size) {
            const double depth = z[grid.index(x + block_size / 2, y + block_size / 2)];
            const double coc = circle_of_confusion(lens, depth);
            const double variance = deviation ? *deviation * *deviation : block_variance(picture, grid, x, y);
            sum += variance / std::max(1.0, std::numbers::pi * coc * coc);
            ++blocks;
        }
    return blocks > 0 ? sum / blocks : 0;
}

} // namespace sparselens
