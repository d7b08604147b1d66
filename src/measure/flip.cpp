#include "measure/flip.h"

#include "base/light.h"
#include "base/parallel.h"
#include "measure/flip_terms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace sparselens {

namespace {

using Plane = std::vector<float>;
using Kernel = std::vector<float>; // of odd length, centred

constexpr std::size_t rows_a_task = 16;

// `weigh` returns the weight at a distance from the centre, in pixels.
template <typename Weigh>
Kernel kernel_of(int reach, const Weigh &weigh) {
    Kernel kernel;
    for (int x = -reach; x <= reach; ++x) kernel.push_back(float(weigh(double(x))));
    return kernel;
}

Kernel scaled(Kernel kernel, double by) {
    for (float &w : kernel) w = float(w * by);
    return kernel;
}

double sum_of(const Kernel &kernel) {
    double sum = 0;
    for (const float w : kernel) sum += w;
    return sum;
}

// Scales the positive weights to a sum of 1, and the negative ones to -1.
Kernel balanced(Kernel kernel) {
    double positive = 0, negative = 0;
    for (const float w : kernel) (w > 0 ? positive : negative) += w;
    for (float &w : kernel) w = float(w > 0 ? w / positive : w / -negative);
    return kernel;
}

// Filters a plane along both axes.
class Filter {
public:
    explicit Filter(const Grid &grid)
        : width_(std::size_t(grid.width())), height_(std::size_t(grid.height())) {}

    Plane operator()(const Plane &plane, const Kernel &along_x, const Kernel &along_y) const {
        Plane rows(plane.size()), result(plane.size());
        parallel_ranges(height_, rows_a_task, [&](std::size_t begin, std::size_t end) {
            const std::size_t reach = along_x.size() / 2;
            Plane padded(width_ + 2 * reach);
            for (std::size_t y = begin; y < end; ++y) {
                const float *row = &plane[y * width_];
                for (std::size_t x = 0; x < padded.size(); ++x)
                    padded[x] = row[std::clamp(x, reach, reach + width_ - 1) - reach];
                for (std::size_t k = 0; k < along_x.size(); ++k)
                    add(&padded[k], along_x[k], &rows[y * width_]);
            }
        });
        parallel_ranges(height_, rows_a_task, [&](std::size_t begin, std::size_t end) {
            const std::size_t reach = along_y.size() / 2;
            for (std::size_t y = begin; y < end; ++y)
                for (std::size_t k = 0; k < along_y.size(); ++k)
                    add(&rows[(std::clamp(y + k, reach, reach + height_ - 1) - reach) * width_], along_y[k],
                        &result[y * width_]);
        });
        return result;
    }

private:
    void add(const float *from, float weight, float *to) const {
        for (std::size_t x = 0; x < width_; ++x) to[x] += weight * from[x];
    }

    std::size_t width_, height_;
};

// A two-dimensional Gaussian is the product of one along x and one along y: each gets the root of its factor.
Kernel gaussian(const FlipGaussian &weight) {
    return kernel_of(flip_filter_reach(), [&](double x) {
        const double degrees = x / flip_pixels_per_degree;
        return weight(degrees * degrees) / std::sqrt(weight(0));
    });
}

struct Kernels {
    Kernel luma = gaussian(flip_luma), red_green = gaussian(flip_red_green),
           blue_yellow = gaussian(flip_blue_yellow), blue_yellow_wide = gaussian(flip_blue_yellow_wide);
    Kernel smooth, edge, point; // a Gaussian and its two derivatives

    Kernels() {
        luma = scaled(luma, 1 / sum_of(luma));
        red_green = scaled(red_green, 1 / sum_of(red_green));
        const double both = std::hypot(sum_of(blue_yellow), sum_of(blue_yellow_wide));
        blue_yellow = scaled(blue_yellow, 1 / both);
        blue_yellow_wide = scaled(blue_yellow_wide, 1 / both);
        const double deviation = flip_feature_deviation();
        const auto bell = [&](double x) { return std::exp(-x * x / (2 * deviation * deviation)); };
        smooth = kernel_of(flip_feature_reach(), bell);
        smooth = scaled(smooth, 1 / sum_of(smooth));
        edge = balanced(kernel_of(flip_feature_reach(), [&](double x) { return -x * bell(x); }));
        point = balanced(kernel_of(
            flip_feature_reach(), [&](double x) { return (x * x / (deviation * deviation) - 1) * bell(x); }));
    }
};

// One picture as the evaluator sees it.
struct Seen {
    std::array<Plane, 3> lab;
    Plane edge, point;
};

void each_row(const Grid &grid, const auto &work) { // calls work(i) for each pixel
    const std::size_t width = std::size_t(grid.width());
    parallel_ranges(std::size_t(grid.height()), rows_a_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin * width; i < end * width; ++i) work(i);
    });
}

Seen seen(const std::array<Plane, 3> &rgb, const Grid &grid, const Kernels &kernels) {
    std::array<Plane, 3> opponent = rgb;
    Plane luma(rgb[0].size()); // [0, 1]
    each_row(grid, [&](std::size_t i) {
        const Imath::V3d value = flip_opponent({rgb[0][i], rgb[1][i], rgb[2][i]});
        luma[i] = float((value.x + 16) / 116);
        for (int c = 0; c < 3; ++c) opponent[std::size_t(c)][i] = float(value[c]);
    });
    const Filter filter(grid);
    opponent[0] = filter(opponent[0], kernels.luma, kernels.luma);
    opponent[1] = filter(opponent[1], kernels.red_green, kernels.red_green);
    const Plane wide = filter(opponent[2], kernels.blue_yellow_wide, kernels.blue_yellow_wide);
    opponent[2] = filter(opponent[2], kernels.blue_yellow, kernels.blue_yellow);
    each_row(grid, [&](std::size_t i) {
        Imath::V3d value = flip_rgb_of_opponent({opponent[0][i], opponent[1][i], opponent[2][i] + wide[i]});
        for (int c = 0; c < 3; ++c) value[c] = std::clamp(value[c], 0.0, 1.0);
        value = flip_lab(value);
        for (int c = 0; c < 3; ++c) opponent[std::size_t(c)][i] = float(value[c]);
    });
    const auto length = [&](const Kernel &derivative) {
        Plane x = filter(luma, derivative, kernels.smooth);
        const Plane y = filter(luma, kernels.smooth, derivative);
        for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::hypot(x[i], y[i]);
        return x;
    };
    return {std::move(opponent), length(kernels.edge), length(kernels.point)};
}

using Shown = float (*)(float value, double exposure); // returns a value in [0, 1]

float as_it_is(float value, double) { return std::clamp(value, 0.0f, 1.0f); }

// The tone curve of film: K. Narkowicz's fit of ACES, for values scaled so that 1 stands for the fit's 0.6.
constexpr std::array<double, 6> film{0.6 * 0.6 * 2.51, 0.6 * 0.03, 0, 0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14};

float tone_mapped_by_film(float value, double exposure) {
    const double x = std::max(0.0, value * exposure);
    const double shown = ((film[0] * x + film[1]) * x + film[2]) / ((film[3] * x + film[4]) * x + film[5]);
    return float(std::clamp(shown, 0.0, 1.0));
}

// The pixels in which either picture has a channel that is not finite.
std::vector<bool> not_finite(const Image &a, const Image &b) {
    std::vector<bool> bad(a.windows.pixels());
    for (const Image *image : {&a, &b})
        for (std::size_t c = 0; c < 3; ++c) {
            const auto plane = image->plane(c);
            for (std::size_t i = 0; i < plane.size(); ++i)
                if (!std::isfinite(plane[i])) bad[i] = true;
        }
    return bad;
}

class Evaluator {
public:
    Evaluator(const Image &image, const Image &reference)
        : grid_(image.windows.width(), image.windows.height()), image_(image), reference_(reference),
          bad_(not_finite(image, reference)) {}

    // Replaces the map by the larger of itself and the map of the pictures shown at this exposure.
    void add(Shown shown, double exposure, std::vector<float> &map) const {
        const Seen a = seen(shown_planes(image_, shown, exposure), grid_, kernels_),
                   b = seen(shown_planes(reference_, shown, exposure), grid_, kernels_);
        each_row(grid_, [&](std::size_t i) {
            const auto lab = [&](const Seen &s) { return Imath::V3d(s.lab[0][i], s.lab[1][i], s.lab[2][i]); };
            const auto features = [&](const Seen &s) { return FlipFeatures{s.edge[i], s.point[i]}; };
            const double error =
                flip_error(flip_colour_error(lab(a), lab(b)), flip_feature_error(features(a), features(b)));
            map[i] = bad_[i] ? std::numeric_limits<float>::quiet_NaN() : std::max(map[i], float(error));
        });
    }

private:
    std::array<Plane, 3> shown_planes(const Image &image, Shown shown, double exposure) const {
        std::array<Plane, 3> planes;
        for (std::size_t c = 0; c < 3; ++c) {
            const auto from = image.plane(c);
            planes[c].resize(from.size());
            each_row(grid_, [&](std::size_t i) { planes[c][i] = bad_[i] ? 0 : shown(from[i], exposure); });
        }
        return planes;
    }

    Grid grid_;
    const Image &image_, &reference_;
    std::vector<bool> bad_;
    Kernels kernels_;
};

} // namespace

std::vector<double> flip_exposures(const Image &reference) {
    std::vector<double> luminances;
    for (std::size_t i = 0; i < reference.windows.pixels(); ++i) {
        double luminance = 0;
        for (std::size_t c = 0; c < 3; ++c) luminance += luma_weights[c] * reference.plane(c)[i];
        if (std::isfinite(luminance)) luminances.push_back(luminance);
    }
    if (luminances.empty()) return {1};
    // The largest value that is not too bright, after the film curve.
    constexpr double bright = 0.85;
    const double a = film[0] - bright * film[3], b = film[1] - bright * film[4],
                 c = film[2] - bright * film[5];
    const double value = (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
    const double black = std::numeric_limits<float>::epsilon();
    const auto median = luminances.begin() + std::ptrdiff_t(luminances.size() / 2);
    std::nth_element(luminances.begin(), median, luminances.end());
    const double stop = std::log2(value / std::max(*median, black));
    const double start = std::log2(value / std::max(*std::ranges::max_element(luminances), black));
    const int count = std::max(2, int(std::ceil(stop - start)));
    std::vector<double> exposures;
    for (int k = 0; k < count; ++k) exposures.push_back(std::exp2(start + k * (stop - start) / (count - 1)));
    return exposures;
}

std::vector<float> flip_map(const Image &image, const Image &reference, FlipRange range) {
    const Evaluator evaluator(image, reference);
    std::vector<float> map(image.windows.pixels());
    if (range == FlipRange::ldr)
        evaluator.add(as_it_is, 1, map);
    else
        for (const double exposure : flip_exposures(reference))
            evaluator.add(tone_mapped_by_film, exposure, map);
    return map;
}

std::vector<double> flip_means(std::span<const float> map, std::span<const std::uint8_t> region_bits,
                               std::size_t regions) {
    std::vector<double> means;
    for (std::size_t set = 0; set <= regions; ++set) {
        double sum = 0;
        std::size_t pixels = 0;
        for (std::size_t i = 0; i < map.size(); ++i) {
            if (std::isnan(map[i]) || (set > 0 && !(region_bits[i] >> (set - 1) & 1))) continue;
            sum += double(map[i]);
            ++pixels;
        }
        means.push_back(sum / double(pixels));
    }
    return means;
}

} // namespace sparselens
