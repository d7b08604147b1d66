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
    for (const char *name : {"R", "G", "B"}) {
        const std::size_t channel = find_channel(image.channels, name);
        if (channel == npos) continue;
        ++channels;
        const auto plane = image.plane(channel);
        for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += tone_mapped(double(plane[i]));
    }
    for (double &value : mean) value /= std::max(channels, 1.0);
    return mean;
}

// Variance of the noise in the block at (x, y), which lies inside the picture's border; 0 where it is not noise that
// shows.
double block_variance(const std::vector<double> &picture, int width, int x, int y) {
    std::array<double, block_size * block_size> residual;
    for (int row = 0; row < block_size; ++row)
        for (int column = 0; column < block_size; ++column) {
            const double *p = &picture[std::size_t(y + row) * std::size_t(width) + std::size_t(x + column)];
            residual[std::size_t(row * block_size + column)] =
                std::abs(*p - (p[-1] + p[1] + p[-width] + p[width]) / 4);
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
    const int width = image.windows.width(), height = image.windows.height();
    const std::vector<double> picture = deviation ? std::vector<double>{} : brightness(image);
    double sum = 0;
    int blocks = 0;
    for (int y = 1; y + block_size < height; y += block_size)
        for (int x = 1; x + block_size < width; x += block_size) {
            const int middle_x = x + block_size / 2, middle_y = y + block_size / 2;
            const double depth =
                double(z[std::size_t(middle_y) * std::size_t(width) + std::size_t(middle_x)]);
            const double coc = circle_of_confusion(lens, depth);
            const double variance =
                deviation ? *deviation * *deviation : block_variance(picture, width, x, y);
            sum += variance / std::max(1.0, std::numbers::pi * coc * coc);
            ++blocks;
        }
    return blocks > 0 ? sum / blocks : 0;
}

} // namespace sparselens
