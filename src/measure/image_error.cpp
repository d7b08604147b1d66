#include "measure/image_error.h"

#include "base/error.h"
#include "base/light.h"
#include "base/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace sparselens {

namespace {

constexpr std::size_t colours = 3, alpha = 3, rgba = 4;
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

// Contribution of a row to a region's figures. Sums are in double, rows in order: the same at any thread count.
struct Sums {
    double squared = 0, squared_tonemapped = 0, squared_srgb = 0, relative = 0, symmetric = 0;
    std::array<double, 2> ssim{}; // tone-mapped, sRGB
    double max = 0, max_alpha = 0;
    std::size_t pixels = 0, windows = 0, nonfinite_image = 0, nonfinite_reference = 0;

    void add(const Sums &row) {
        squared += row.squared;
        squared_tonemapped += row.squared_tonemapped;
        squared_srgb += row.squared_srgb;
        relative += row.relative;
        symmetric += row.symmetric;
        for (std::size_t i = 0; i < ssim.size(); ++i) ssim[i] += row.ssim[i];
        max = std::max(max, row.max);
        max_alpha = std::max(max_alpha, row.max_alpha);
        pixels += row.pixels;
        windows += row.windows;
        nonfinite_image += row.nonfinite_image;
        nonfinite_reference += row.nonfinite_reference;
    }
};

using Pixel = std::array<float, rgba>;

struct Planes {
    std::array<const float *, rgba> channels;

    explicit Planes(const Image &image) {
        for (std::size_t c = 0; c < rgba; ++c) channels[c] = image.plane(c).data();
    }
    Pixel operator[](std::size_t i) const {
        return {channels[0][i], channels[1][i], channels[2][i], channels[3][i]};
    }
};

bool is_finite(const Pixel &pixel) {
    return std::all_of(pixel.begin(), pixel.end(), [](float v) { return std::isfinite(v); });
}

struct Luma {
    float image = not_a_number, reference = not_a_number; // NaN where either picture is not finite
};
using Lumas = std::array<Luma, 2>; // tone-mapped, sRGB

struct PixelError {
    Sums sums;
    Lumas luma;
};

PixelError error_of(const Pixel &image, const Pixel &reference) {
    PixelError error;
    Sums &sums = error.sums;
    sums.nonfinite_image = !is_finite(image);
    sums.nonfinite_reference = !is_finite(reference);
    if (sums.nonfinite_image || sums.nonfinite_reference) return error;
    std::array<std::array<double, 2>, 2> luma{};
    for (std::size_t c = 0; c < colours; ++c) {
        const double a = image[c], b = reference[c], difference = std::abs(a - b),
                     square = difference * difference;
        const double tone_a = tone_mapped(a), tone_b = tone_mapped(b),
                     srgb_a = srgb_encoded(std::clamp(a, 0.0, 1.0)),
                     srgb_b = srgb_encoded(std::clamp(b, 0.0, 1.0));
        sums.squared += square;
        sums.squared_tonemapped += (tone_a - tone_b) * (tone_a - tone_b);
        sums.squared_srgb += (srgb_a - srgb_b) * (srgb_a - srgb_b);
        sums.relative += square / (b * b + 0.01);
        sums.symmetric += difference / (std::abs(a) + std::abs(b) + 0.01);
        sums.max = std::max(sums.max, difference);
        luma[0][0] += luma_weights[c] * tone_a;
        luma[0][1] += luma_weights[c] * tone_b;
        luma[1][0] += luma_weights[c] * srgb_a;
        luma[1][1] += luma_weights[c] * srgb_b;
    }
    sums.max_alpha = std::abs(double(image[alpha]) - double(reference[alpha]));
    sums.pixels = 1;
    for (std::size_t i = 0; i < luma.size(); ++i) error.luma[i] = {float(luma[i][0]), float(luma[i][1])};
    return error;
}

// The whole picture counts as set 0, region r as set r + 1.
struct PixelSets {
    std::span<const std::uint8_t> region_bits;
    std::size_t count;

    bool holds(std::size_t set, std::size_t pixel) const {
        return set == 0 || (region_bits[pixel] >> (set - 1) & 1);
    }
};

using RowSums = std::vector<Sums>; // one per pixel set

// The contribution of a block of the picture to one pixel set, from tone-mapped values.
struct Block {
    double squared = 0;
    std::size_t pixels = 0;
};
constexpr std::size_t block_size = 8;
using Blocks = std::vector<std::vector<Block>>; // [pixel set][block]

// The mean square of the worst 1 % of the blocks; NaN if there are none.
double worst_of(const std::vector<Block> &blocks) {
    std::vector<double> means;
    for (const Block &block : blocks)
        if (block.pixels > 0) means.push_back(block.squared / double(colours * block.pixels));
    const std::size_t worst = pieces_of(means.size(), std::size_t(100));
    std::partial_sort(means.begin(), means.begin() + std::ptrdiff_t(worst), means.end(), std::greater());
    double sum = 0;
    for (std::size_t i = 0; i < worst; ++i) sum += means[i];
    return sum / double(worst);
}

// The 99th percentile (nearest rank) of |a - b| over the channel values of a pixel set.
double percentile_99(const Image &image, const Image &reference, const PixelSets &sets, std::size_t set) {
    const Planes image_planes(image), reference_planes(reference);
    std::vector<float> errors;
    for (std::size_t i = 0; i < image.windows.pixels(); ++i) {
        if (!sets.holds(set, i)) continue;
        const Pixel a = image_planes[i], b = reference_planes[i];
        if (!is_finite(a) || !is_finite(b)) continue;
        for (std::size_t c = 0; c < colours; ++c)
            errors.push_back(float(std::abs(double(a[c]) - double(b[c]))));
    }
    if (errors.empty()) return not_a_number;
    const auto rank = std::ptrdiff_t((errors.size() * 99 + 99) / 100 - 1);
    std::nth_element(errors.begin(), errors.begin() + rank, errors.end());
    return errors[std::size_t(rank)];
}

double decibels(double mean_square) { return -10 * std::log10(mean_square); }

ErrorFigures figures_of(const Sums &sums, double worst, double p99) {
    const double values = double(colours * sums.pixels);
    const bool any = sums.pixels > 0;
    return {.psnr = decibels(sums.squared / values),
            .psnr_tonemapped = decibels(sums.squared_tonemapped / values),
            .psnr_srgb = decibels(sums.squared_srgb / values),
            .psnr_worst = decibels(worst),
            .relmse = sums.relative / values,
            .smape = sums.symmetric / values,
            .ssim = sums.ssim[0] / double(sums.windows),
            .ssim_srgb = sums.ssim[1] / double(sums.windows),
            .p99 = p99,
            .max = any ? sums.max : not_a_number,
            .max_alpha = any ? sums.max_alpha : not_a_number,
            .pixels = sums.pixels,
            .nonfinite_image = sums.nonfinite_image,
            .nonfinite_reference = sums.nonfinite_reference};
}

struct LumaPlanes {
    std::vector<float> image, reference;
};

// Returns the planes of Lumas.
std::array<LumaPlanes, 2> add_pixel_errors(const Image &image, const Image &reference, const PixelSets &sets,
                                           std::vector<RowSums> &rows, Blocks &blocks) {
    const Planes image_planes(image), reference_planes(reference);
    const std::size_t width = std::size_t(image.windows.width());
    const std::vector<float> plane(image.windows.pixels());
    std::array<LumaPlanes, 2> luma{LumaPlanes{plane, plane}, LumaPlanes{plane, plane}};
    const std::size_t columns = pieces_of(width, block_size);
    for (auto &of_set : blocks) of_set.resize(columns * pieces_of(rows.size(), block_size));
    parallel_ranges(rows.size(), block_size, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin * width; i < end * width; ++i) {
            const PixelError error = error_of(image_planes[i], reference_planes[i]);
            for (std::size_t n = 0; n < luma.size(); ++n) {
                luma[n].image[i] = error.luma[n].image;
                luma[n].reference[i] = error.luma[n].reference;
            }
            for (std::size_t set = 0; set < sets.count; ++set) {
                if (!sets.holds(set, i)) continue;
                rows[i / width][set].add(error.sums);
                Block &block = blocks[set][begin / block_size * columns + i % width / block_size];
                block.squared += error.sums.squared_tonemapped;
                block.pixels += error.sums.pixels;
            }
        }
    });
    return luma;
}

void add_similarity(const std::array<LumaPlanes, 2> &luma, const ArrayGrid &pixels, const PixelSets &sets,
                    std::vector<RowSums> &rows) {
    const auto map_of = [&](const LumaPlanes &of) {
        return ssim_map(of.image, of.reference, pixels.width(), pixels.height());
    };
    const SsimMap ssim = map_of(luma[0]), ssim_srgb = map_of(luma[1]);
    const ArrayGrid windows(ssim.width, ssim.height);
    parallel_for(std::size_t(ssim.height), [&](std::size_t y) {
        for (int x = 0; x < ssim.width; ++x) {
            const std::size_t window = windows.index(Position(x, int(y)));
            const double value = ssim.values[window];
            if (std::isnan(value)) continue; // the window holds a pixel that is not finite
            const std::size_t centre = pixels.index(Position(x + ssim.centre_x, int(y) + ssim.centre_y));
            for (std::size_t set = 0; set < sets.count; ++set) {
                if (!sets.holds(set, centre)) continue;
                rows[y][set].ssim[0] += value;
                rows[y][set].ssim[1] += ssim_srgb.values[window];
                ++rows[y][set].windows;
            }
        }
    });
}

} // namespace

Image rgba_over(const Image &image, const Windows &target, const std::string &file) {
    const Windows &from = image.windows;
    if (from.display_width() != target.display_width() || from.display_height() != target.display_height())
        throw Error(fmt::format("{}: the display window is {}x{}, that of the reference {}x{}", file,
                                from.display_width(), from.display_height(), target.display_width(),
                                target.display_height()));
    Image result(target, rgba_channels());
    const Imath::V2i shift = from.display.min - target.display.min;
    for (std::size_t c = 0; c < rgba; ++c) {
        const std::size_t channel = find_channel(image.channels, result.channels[c].name);
        if (channel == npos && c != alpha)
            throw Error(
                fmt::format("{}: has no channel {}, which is compared", file, result.channels[c].name));
        for (int y = target.data.min.y; y <= target.data.max.y; ++y)
            for (int x = target.data.min.x; x <= target.data.max.x; ++x) {
                const Imath::V2i p = Imath::V2i(x, y) + shift;
                if (!from.data.intersects(p)) continue;
                result.at(c, x, y) = channel == npos ? 1 : image.at(channel, p.x, p.y);
            }
    }
    return result;
}

std::vector<ErrorFigures> image_error(const Image &image, const Image &reference,
                                      std::span<const std::uint8_t> region_bits, std::size_t regions) {
    const PixelSets sets{region_bits, regions + 1};
    const int width = image.windows.width(), height = image.windows.height();
    std::vector<RowSums> rows(std::size_t(height), RowSums(sets.count));
    Blocks blocks(sets.count);
    add_similarity(add_pixel_errors(image, reference, sets, rows, blocks), ArrayGrid(width, height), sets,
                   rows);
    std::vector<ErrorFigures> figures(sets.count);
    parallel_for(sets.count, [&](std::size_t set) {
        Sums sums;
        for (const RowSums &row : rows) sums.add(row[set]);
        figures[set] = figures_of(sums, worst_of(blocks[set]), percentile_99(image, reference, sets, set));
    });
    return figures;
}

namespace {

// Weighted sums of a, b, a^2, b^2, ab, in double, because a variance is the difference of two nearly equal sums.
constexpr std::size_t moments = 5;
using MomentRows = std::array<std::vector<double>, moments>;

// The moments of each column over the rows of one window.
void add_columns(std::span<const float> a, std::span<const float> b, double weight, MomentRows &sums) {
    for (std::size_t x = 0; x < a.size(); ++x) {
        const double va = a[x], vb = b[x], wa = weight * va, wb = weight * vb;
        sums[0][x] += wa;
        sums[1][x] += wb;
        sums[2][x] += wa * va;
        sums[3][x] += wb * vb;
        sums[4][x] += wa * vb;
    }
}

double similarity(const std::array<double, moments> &m) {
    const double mean_product = m[0] * m[1], mean_squares = m[0] * m[0] + m[1] * m[1];
    const double covariance = m[4] - mean_product, variances = m[2] + m[3] - mean_squares;
    return (2 * mean_product + ssim_c1) * (2 * covariance + ssim_c2) /
           ((mean_squares + ssim_c1) * (variances + ssim_c2));
}

void combine_columns(const MomentRows &columns, std::span<const double> window, std::span<double> row) {
    for (std::size_t x = 0; x < row.size(); ++x) {
        std::array<double, moments> m{};
        for (std::size_t i = 0; i < moments; ++i)
            m[i] =
                std::inner_product(window.begin(), window.end(), columns[i].begin() + std::ptrdiff_t(x), 0.0);
        row[x] = similarity(m);
    }
}

} // namespace

std::vector<double> ssim_window(int size) {
    constexpr double sigma = 1.5;
    std::vector<double> weights(static_cast<std::size_t>(size));
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const double x = (double(i) - (size - 1) / 2.0) / sigma;
        weights[i] = std::exp(-x * x / 2);
    }
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double &w : weights) w /= sum;
    return weights;
}

SsimMap ssim_map(std::span<const float> a, std::span<const float> b, int width, int height) {
    const int size_x = std::min(width, ssim_window_size), size_y = std::min(height, ssim_window_size);
    SsimMap map{width - size_x + 1, height - size_y + 1, size_x / 2, size_y / 2, {}};
    map.values.resize(std::size_t(map.width) * std::size_t(map.height));
    const std::vector<double> window_x = ssim_window(size_x), window_y = ssim_window(size_y);
    const std::size_t row_length = std::size_t(width), map_length = std::size_t(map.width);
    constexpr std::size_t rows_a_task = 16;
    parallel_ranges(std::size_t(map.height), rows_a_task, [&](std::size_t begin, std::size_t end) {
        MomentRows columns;
        for (std::size_t y = begin; y < end; ++y) {
            for (auto &row : columns) row.assign(row_length, 0.0);
            for (std::size_t k = 0; k < window_y.size(); ++k)
                add_columns(a.subspan((y + k) * row_length, row_length),
                            b.subspan((y + k) * row_length, row_length), window_y[k], columns);
            combine_columns(columns, window_x, std::span(map.values).subspan(y * map_length, map_length));
        }
    });
    return map;
}

} // namespace sparselens
