#include "plan/noise.h"

#include "base/parallel.h"
#include "plan/brightness.h"
#include "plan/tuning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace sparselens {

namespace {

constexpr int block_size = 8;

// Variance of the noise in the block at (x, y), which lies inside the picture's border, measured by second differences
// in steps of `step` pixels; 0 if they are not Gaussian.
double variance_along(const std::vector<double> &picture, const Grid &grid, int x, int y,
                      std::ptrdiff_t step) {
    const Grid block(block_size, block_size);
    std::array<double, block_size * block_size> residual;
    for (std::size_t i = 0; i < residual.size(); ++i) {
        const Imath::V2i at = block.pixel(i) + Imath::V2i(x, y);
        const double *p = &picture[grid.index(at.x, at.y)];
        residual[i] = std::abs(*p - (p[-step] + p[step]) / 2);
    }
    std::ranges::sort(residual);
    constexpr double spread = 1.5;                   // variance of a value minus the mean of two others
    const auto quantile = [&](std::size_t quarter) { // between two values
        const std::size_t i = quarter * residual.size() / 4;
        return (residual[i - 1] + residual[i]) / 2;
    };
    const double by_quartile = quantile(1) / 0.3186, by_median = quantile(2) / 0.6745;
    return by_quartile > 0.75 * by_median ? by_median * by_median / spread : 0;
}

// The variance along the direction in which the block is smoothest.
double block_variance(const std::vector<double> &picture, const Grid &grid, int x, int y) {
    constexpr double least_of_four =
        0.63; // the least of four measurements of Gaussian noise, relative to its variance
    const std::ptrdiff_t row = grid.width();
    double least = std::numeric_limits<double>::infinity();
    for (const std::ptrdiff_t step : {std::ptrdiff_t{1}, row, row + 1, row - 1})
        least = std::min(least, variance_along(picture, grid, x, y, step));
    return least / least_of_four;
}

// The variances of the blocks inside the picture's border, each averaged with the blocks around it.
class BlockVariances {
public:
    BlockVariances(const Image &image, const Grid &grid)
        : blocks_(std::max((grid.width() - 2) / block_size, 0),
                  std::max((grid.height() - 2) / block_size, 0)),
          variance_(blocks_.size()) {
        const std::vector<double> picture = brightness(image);
        std::vector<double> own(blocks_.size());
        parallel_for(own.size(), [&](std::size_t i) {
            const Imath::V2i at = blocks_.pixel(i) * block_size + Imath::V2i(1);
            own[i] = block_variance(picture, grid, at.x, at.y);
        });
        for (std::size_t i = 0; i < own.size(); ++i)
            if (noise_around(own, blocks_.pixel(i))) variance_[i] = mean_around(own, blocks_.pixel(i));
    }

    // The variance of the block that holds the pixel, or of the nearest block.
    double at(int x, int y) const {
        if (variance_.empty()) return 0;
        return variance_[blocks_.index(std::clamp((x - 1) / block_size, 0, blocks_.width() - 1),
                                       std::clamp((y - 1) / block_size, 0, blocks_.height() - 1))];
    }

private:
    // Calls visit(a block's own variance) for the block and the blocks around it.
    template <typename Visit>
    void around(const std::vector<double> &own, const Imath::V2i &block, int reach,
                const Visit &visit) const {
        for (int y = block.y - reach; y <= block.y + reach; ++y)
            for (int x = block.x - reach; x <= block.x + reach; ++x)
                if (blocks_.contains(x, y)) visit(own[blocks_.index(x, y)]);
    }

    // Noise is everywhere, but aliased texture looks like it here and there.
    bool noise_around(const std::vector<double> &own, const Imath::V2i &block) const {
        int gaussian = 0, count = 0;
        around(own, block, PlanTuning::noise_surroundings, [&](double variance) {
            gaussian += variance > 0;
            ++count;
        });
        return gaussian >= PlanTuning::least_gaussian * count;
    }

    double mean_around(const std::vector<double> &own, const Imath::V2i &block) const {
        double sum = 0;
        int count = 0;
        around(own, block, 1, [&](double variance) {
            sum += variance;
            ++count;
        });
        return sum / count;
    }

    Grid blocks_;
    std::vector<double> variance_;
};

} // namespace

std::vector<double> noise_in_lens_picture(const Image &image, std::span<const float> z, const ThinLens &lens,
                                          std::optional<double> deviation) {
    const Grid grid(image.windows.width(), image.windows.height());
    const auto measured =
        deviation ? std::nullopt : std::optional<BlockVariances>(std::in_place, image, grid);
    std::vector<double> noise(grid.size());
    for (std::size_t i = 0; i < noise.size(); ++i) {
        const Imath::V2i at = grid.pixel(i);
        const double coc = circle_of_confusion(lens, z[i]);
        const double variance = measured ? measured->at(at.x, at.y) : *deviation * *deviation;
        noise[i] = variance / std::max(1.0, std::numbers::pi * coc * coc);
    }
    return noise;
}

} // namespace sparselens
