#include "base/numbers.h"
#include "view/fitted_depth.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace sparselens {
namespace {

using Colour = std::array<float, 3>;

Image picture_of(const Windows &windows, const std::function<Colour(Imath::V2i)> &colour) {
    Image image(windows, {{"R"}, {"G"}, {"B"}});
    for (std::size_t i = 0; i < windows.pixels(); ++i)
        for (std::size_t k = 0; k < 3; ++k) image.plane(k)[i] = colour(windows.pixel(i))[k];
    return image;
}

float noise(std::uint32_t a, std::uint32_t b) { return float(unit_interval(mix_bits(a, b))); }

// Two surfaces with texture, whose edge leans.
Image textured(const Windows &windows) {
    return picture_of(windows, [](Imath::V2i at) {
        const bool near = 3 * at.x + at.y < 110;
        const float grain = 0.1f * noise(std::uint32_t(at.x), std::uint32_t(at.y));
        return near ? Colour{0.7f + grain, 0.5f, 0.3f} : Colour{0.2f, 0.3f + grain, 0.4f};
    });
}

std::vector<float> depths_of(const ArrayGrid &cells, const std::function<float(Position)> &depth) {
    std::vector<float> all(cells.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = depth(cells.position(i));
    return all;
}

std::vector<float> uneven(const ArrayGrid &cells) {
    return depths_of(cells, [&](Position at) {
        return noise(std::uint32_t(at.column), 7) * 0.1f + (5 * at.column + at.row < 28 ? 0.8f : 0.1f);
    });
}

// The formulas of the header, for one pixel at a time; `half` of the weights are below the result.
class Slowly {
public:
    Slowly(const Image &picture, const ArrayGrid &cells, const std::vector<float> &depths)
        : picture_(picture), cells_(cells), depths_(depths) {}

    float at(Imath::V2i pixel, double half) const {
        const Imath::Box2i &frame = picture_.windows.display;
        const Imath::V2i held(std::clamp(pixel.x, frame.min.x, frame.max.x),
                              std::clamp(pixel.y, frame.min.y, frame.max.y));
        const double x = place(held.x, frame.min.x, frame.max.x, cells_.width()),
                     y = place(held.y, frame.min.y, frame.max.y, cells_.height());
        const int column = int(std::floor(x + 0.5)), row = int(std::floor(y + 0.5));
        double spread = 0, count = 0;
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                const auto [colour, variance, square, pixels] = colours(column + dx, row + dy);
                if (pixels == 0) continue;
                spread += variance + square / 65536;
                ++count;
            }
        spread /= std::max(count, 1.0);
        std::vector<std::pair<double, double>> said; // and its weight
        double sum = 0;
        for (int dy = -2; dy <= 2; ++dy)
            for (int dx = -2; dx <= 2; ++dx) {
                const int c = column + dx, r = row + dy;
                const auto [colour, variance, square, pixels] = colours(c, r);
                if (pixels == 0 || std::isnan(depth(c, r))) continue;
                double off = 0;
                for (std::size_t k = 0; k < 3; ++k)
                    off += std::pow(double(picture_.at(k, pixel.x, pixel.y)) - colour[k], 2);
                const double distance = (c - x) * (c - x) + (r - y) * (r - y);
                const double weight =
                    std::exp(-distance / 2) * (1 - mixed(c, r) / 2) / std::pow(1 + off / (2 * spread), 2);
                said.emplace_back(depth(c, r) + slope(c, r, 1, 0) * (x - clamped(c, r).column) +
                                      slope(c, r, 0, 1) * (y - clamped(c, r).row),
                                  weight);
                sum += weight;
            }
        std::ranges::sort(said);
        for (double below = 0; const auto &[value, weight] : said)
            if ((below += weight) >= half * sum) return float(value);
        return std::numeric_limits<float>::quiet_NaN();
    }

private:
    struct Colours {
        std::array<double, 3> mean{};
        double variance = 0, square = 0, pixels = 0;
    };
    static double place(int at, int first, int last, int cells) {
        return (at - first + 0.5) * cells / (last - first + 1) - 0.5;
    }
    Position clamped(int column, int row) const {
        return Position(std::clamp(column, 0, cells_.width() - 1), std::clamp(row, 0, cells_.height() - 1));
    }
    double depth(int column, int row) const { return double(depths_[cells_.index(clamped(column, row))]); }
    double slope(int column, int row, int dx, int dy) const {
        const auto [c, r] = clamped(column, row);
        const double a = depth(c, r) - depth(c - dx, r - dy), b = depth(c + dx, r + dy) - depth(c, r);
        if (std::isnan(a) || std::isnan(b) || a * b <= 0) return 0;
        return std::abs(a) < std::abs(b) ? a : b;
    }
    double mixed(int column, int row) const {
        const auto [c, r] = clamped(column, row);
        double least = depth(c, r), most = least;
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx)
                if (const double d = depth(c + dx, r + dy); !std::isnan(d))
                    least = std::min(least, d), most = std::max(most, d);
        const double size = most - least;
        return size > 0 ? 4 * (depth(c, r) - least) * (most - depth(c, r)) / (size * size) : 0;
    }
    Colours colours(int column, int row) const {
        const Position cell = clamped(column, row);
        const Imath::Box2i &frame = picture_.windows.display,
                           inside = common_box(frame, picture_.windows.data);
        Colours result;
        for (int y = inside.min.y; y <= inside.max.y; ++y)
            for (int x = inside.min.x; x <= inside.max.x; ++x)
                if (std::floor(place(x, frame.min.x, frame.max.x, cells_.width()) + 0.5) == cell.column &&
                    std::floor(place(y, frame.min.y, frame.max.y, cells_.height()) + 0.5) == cell.row) {
                    for (std::size_t k = 0; k < 3; ++k) {
                        const double c = double(picture_.at(k, x, y));
                        result.mean[k] += c;
                        result.square += c * c;
                    }
                    ++result.pixels;
                }
        if (result.pixels == 0) return result;
        result.square /= result.pixels;
        result.variance = result.square;
        for (double &mean : result.mean) {
            mean /= result.pixels;
            result.variance -= mean * mean;
        }
        return result;
    }

    const Image &picture_;
    ArrayGrid cells_;
    std::vector<float> depths_;
};

// The frame, and one with a corner whose data window is partly beyond it.
const std::vector<Windows> &frames() {
    static const std::vector<Windows> all{windows_of_size(37, 29),
                                          {{{5, -3}, {44, 26}}, {{9, -6}, {49, 20}}, 1}};
    return all;
}

TEST(FitDepth, IsTheWeightedMedian) {
    const ArrayGrid cells(8, 6); // of 4.6 x 4.8 pixels
    std::vector<float> depths = uneven(cells);
    depths[cells.index(Position(2, 3))] = std::numeric_limits<float>::quiet_NaN();
    for (const Windows &windows : frames()) {
        const Image picture = textured(windows);
        const std::vector<float> fast = fit_depth(picture, cells, depths);
        const Slowly slow(picture, cells, depths);
        for (std::size_t i = 0; i < fast.size(); ++i) { // by rounding, another one may be in the middle
            const Imath::V2i at = windows.pixel(i);
            ASSERT_GE(fast[i], slow.at(at, 0.499) - 1e-6f) << at;
            ASSERT_LE(fast[i], slow.at(at, 0.501) + 1e-6f) << at;
        }
    }
}

// The two surfaces of a picture of 60 x 40 pixels: the near one ends at column 27, in the middle of a cell.
constexpr int edge = 27;
Image two_colours(float light = 1) {
    return picture_of(windows_of_size(60, 40), [&](Imath::V2i at) {
        return at.x < edge ? Colour{0.5f * light, 0.4f * light, 0.3f * light}
                           : Colour{0.2f * light, 0.25f * light, 0.4f * light};
    });
}
const ArrayGrid cells_of_two(12, 8); // the sixth column of cells mixes both: columns 25 to 29
std::vector<float> depths_of_two(float mixed) {
    return depths_of(cells_of_two, [&](Position at) {
        return at.column < 5 ? 0.9f : at.column > 5 ? 0.1f : mixed;
    });
}

TEST(FitDepth, MovesTheEdgeToThatOfTheColours) {
    for (const float mixed : {0.1f, 0.42f, 0.9f})
        for (const float light : {1.0f, 64.0f, 0x1p-20f}) {
            const Image picture = two_colours(light);
            const std::vector<float> fitted = fit_depth(picture, cells_of_two, depths_of_two(mixed));
            for (std::size_t i = 0; i < fitted.size(); ++i) {
                const Imath::V2i at = picture.windows.pixel(i);
                ASSERT_EQ(fitted[i], at.x < edge ? 0.9f : 0.1f) << at << ' ' << mixed << ' ' << light;
            }
        }
}

TEST(FitDepth, LeavesConstantsAndPlanes) {
    const Windows windows = windows_of_size(60, 40);
    const ArrayGrid cells(12, 8);
    for (const float depth : {0.3f, std::numeric_limits<float>::infinity()})
        for (const float fitted : fit_depth(textured(windows), cells, std::vector(cells.size(), depth)))
            ASSERT_EQ(fitted, depth);
    const std::vector<float> plane =
        fit_depth(textured(windows), cells, depths_of(cells, [](Position at) {
                      return 0.1f + 0.05f * float(at.column) + 0.02f * float(at.row);
                  }));
    for (std::size_t i = 0; i < plane.size(); ++i) {
        const Imath::V2i at = windows.pixel(i);
        if (at.x < 15 || at.x >= 45 || at.y < 15 || at.y >= 25) continue; // cells of the border have no slope
        ASSERT_NEAR(plane[i],
                    0.1f + 0.05f * ((float(at.x) + 0.5f) / 5 - 0.5f) +
                        0.02f * ((float(at.y) + 0.5f) / 5 - 0.5f),
                    1e-6f)
            << at;
    }
}

TEST(FitDepth, LeavesThatOfThePicturesSizeAndTakesPixelsOfALargerOne) {
    const Windows windows = windows_of_size(37, 29);
    const std::vector<float> same = uneven(windows.grid().array());
    EXPECT_EQ(fit_depth(textured(windows), windows.grid().array(), same), same);
    const ArrayGrid larger(111, 87);
    const std::vector<float> large = uneven(larger), fitted = fit_depth(textured(windows), larger, large);
    for (std::size_t i = 0; i < fitted.size(); ++i) {
        const Imath::V2i at = windows.pixel(i);
        ASSERT_EQ(fitted[i], large[larger.index(Position(3 * at.x + 1, 3 * at.y + 1))]) << at;
    }
}

TEST(FitDepth, FillsUnknownCellsFromThoseAround) {
    const float nothing = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> depths = depths_of_two(0.42f);
    depths[cells_of_two.index(Position(2, 4))] = nothing;
    for (const float fitted : fit_depth(two_colours(), cells_of_two, depths))
        ASSERT_TRUE(fitted == 0.9f || fitted == 0.1f);
    for (const float fitted :
         fit_depth(two_colours(), cells_of_two, std::vector(cells_of_two.size(), nothing)))
        ASSERT_TRUE(std::isnan(fitted));
}

TEST(FitDepth, BearsAnyColour) {
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 3e38f}) {
        Image picture = two_colours();
        for (std::size_t k = 0; k < 3; ++k) picture.at(k, 40, 20) = bad;
        const std::vector<float> fitted = fit_depth(picture, cells_of_two, depths_of_two(0.42f));
        for (std::size_t i = 0; i < fitted.size(); ++i)
            ASSERT_GE(fitted[i], 0.1f) << picture.windows.pixel(i) << ' ' << bad;
        EXPECT_EQ(fitted[picture.windows.index(Imath::V2i(5, 20))], 0.9f);
        EXPECT_EQ(fitted[picture.windows.index(Imath::V2i(50, 20))], 0.1f);
    }
}

TEST(FitDepth, TurnsWithThePicture) {
    const Windows windows = windows_of_size(60, 40), on_side = windows_of_size(40, 60);
    const ArrayGrid cells(12, 8);
    const std::vector<float> depths = uneven(cells), plain = fit_depth(textured(windows), cells, depths);
    const Image picture = textured(windows);
    const auto colour = [&](int x, int y) {
        return Colour{picture.at(0, x, y), picture.at(1, x, y), picture.at(2, x, y)};
    };
    const std::vector<float> mirrored = fit_depth(
        picture_of(windows, [&](Imath::V2i at) { return colour(59 - at.x, at.y); }), cells,
        depths_of(cells, [&](Position at) { return depths[cells.index(Position(11 - at.column, at.row))]; }));
    const std::vector<float> transposed =
        fit_depth(picture_of(on_side, [&](Imath::V2i at) { return colour(at.y, at.x); }), ArrayGrid(8, 12),
                  depths_of(ArrayGrid(8, 12),
                            [&](Position at) { return depths[cells.index(Position(at.row, at.column))]; }));
    for (std::size_t i = 0; i < plain.size(); ++i) {
        const Imath::V2i at = windows.pixel(i);
        ASSERT_NEAR(mirrored[windows.index(Imath::V2i(59 - at.x, at.y))], plain[i], 1e-6f) << at;
        ASSERT_NEAR(transposed[on_side.index(Imath::V2i(at.y, at.x))], plain[i], 1e-6f) << at;
    }
}

TEST(FitDepth, IsTheSameForAllThreads) {
    const ArrayGrid cells(50, 40);
    const Image picture = textured(windows_of_size(201, 163));
    const std::vector<float> plain = fit_depth(picture, cells, uneven(cells));
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(fit_depth(picture, cells, uneven(cells)), plain);
}

TEST(FitDepth, NeedsNoColours) {
    const Image grey(windows_of_size(60, 40), {{"Y"}});
    for (const float fitted : fit_depth(grey, cells_of_two, depths_of_two(0.42f)))
        ASSERT_TRUE(fitted >= 0.1f && fitted <= 0.9f);
}

} // namespace
} // namespace sparselens
