#include "view/fitted_depth.h"

#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace sparselens {

namespace {

constexpr int reach = 2, side = 2 * reach + 1; // cells
constexpr std::size_t width = 8;               // of `side` cells in arrays, for a processor's vectors

// The columns, or the rows, of the pixels among the cells.
struct Axis {
    std::vector<int> cell;    // that holds the middle of the pixel
    std::vector<float> place; // of this middle, in cells; 0: the middle of the first one
    std::vector<std::array<float, width>> nearness; // weights of the cells around it

    Axis(int first, int last, int frame_first, int frame_size, int cells) {
        for (int i = first; i <= last; ++i) {
            const int in_frame = std::clamp(i - frame_first, 0, frame_size - 1);
            const double at = (in_frame + 0.5) * cells / frame_size;
            cell.push_back(std::min(int(at), cells - 1));
            place.push_back(float(at - 0.5));
            auto &weights = nearness.emplace_back();
            for (int k = 0; k < side; ++k) {
                const float d = float(cell.back() + k - reach) - place.back();
                weights[std::size_t(k)] = std::exp(-d * d / 2);
            }
        }
    }
    // The pixels of a cell: [begin, end).
    std::array<std::size_t, 2> pixels(int of) const {
        const auto [begin, end] = std::equal_range(cell.begin(), cell.end(), of);
        return {std::size_t(begin - cell.begin()), std::size_t(end - cell.begin())};
    }
};

struct Cell {
    std::array<float, 3> colour{};  // the mean over its pixels
    float variance = 0, square = 0; // of the colours, and their mean square: sums over the channels
    float share = 0;                // 1 - m / 2; 0: it has no depth or no pixels
    float depth = 0, slope_x = 0, slope_y = 0;
};

// The smaller one of the slopes on both sides; 0 at a peak, at a step to infinity, and if one is unknown.
float slope(float before, float here, float after) {
    const float a = here - before, b = after - here;
    return a * b > 0 && std::isfinite(a * b) ? std::copysign(std::min(std::abs(a), std::abs(b)), a) : 0;
}

class Fit {
public:
    Fit(const Image &picture, const ArrayGrid &grid, const Axis &columns, const Axis &rows,
        std::span<const float> depths)
        : windows_(picture.windows), grid_(grid), columns_(columns), rows_(rows), cells_(grid.size()) {
        const std::array rgb = find_rgb(picture.channels);
        for (std::size_t k = 0; k < rgb.size(); ++k)
            if (rgb[k] != npos) rgb_[k] = picture.plane(rgb[k]);
        parallel_for(std::size_t(grid.height()), [&](std::size_t row) {
            for (int column = 0; column < grid.width(); ++column)
                describe(Position(column, int(row)), depths);
        });
    }

    std::vector<float> medians() const {
        std::vector<float> result(windows_.pixels());
        parallel_for(std::size_t(grid_.height()), [&](std::size_t row) {
            for (int column = 0; column < grid_.width(); ++column) fill(Position(column, int(row)), result);
        });
        return result;
    }

private:
    Position held(const Position &at) const {
        return Position(std::clamp(at.column, 0, grid_.width() - 1),
                        std::clamp(at.row, 0, grid_.height() - 1));
    }
    std::array<float, 3> colour(std::size_t pixel) const {
        std::array<float, 3> result{};
        for (std::size_t k = 0; k < 3; ++k)
            if (!rgb_[k].empty() && std::isfinite(rgb_[k][pixel]))
                result[k] =
                    std::clamp(rgb_[k][pixel], -65504.0f, 65504.0f); // those of a half have finite squares
        return result;
    }
    // Calls visit(pixel, x, y) for each pixel of a cell: its index, its column and its row.
    template <typename Visit>
    void for_pixels(const Position &at, const Visit &visit) const {
        const auto [x0, x1] = columns_.pixels(at.column);
        const auto [y0, y1] = rows_.pixels(at.row);
        for (std::size_t y = y0; y < y1; ++y)
            for (std::size_t x = x0; x < x1; ++x) visit(windows_.index(Position(int(x), int(y))), x, y);
    }

    void describe(const Position &at, std::span<const float> depths) {
        Cell &cell = cells_[grid_.index(at)];
        std::array<double, 3> sum{};
        double squares = 0, count = 0;
        for_pixels(at, [&](std::size_t pixel, std::size_t, std::size_t) {
            if (!windows_.display.intersects(windows_.pixel(pixel))) return;
            const std::array<float, 3> c = colour(pixel);
            for (std::size_t k = 0; k < 3; ++k)
                sum[k] += double(c[k]), squares += double(c[k]) * double(c[k]);
            ++count;
        });
        const auto depth = [&](int x, int y) { return depths[grid_.index(held(at + Imath::V2i(x, y)))]; };
        if (!(count > 0) || std::isnan(depth(0, 0))) return;
        double mean_square = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            cell.colour[k] = float(sum[k] / count);
            mean_square += sum[k] / count * (sum[k] / count);
        }
        cell.square = float(squares / count);
        cell.variance = float(std::max(0.0, squares / count - mean_square));
        cell.depth = depth(0, 0);
        cell.slope_x = slope(depth(-1, 0), cell.depth, depth(1, 0));
        cell.slope_y = slope(depth(0, -1), cell.depth, depth(0, 1));
        float least = cell.depth, most = cell.depth;
        for (int i = 0; i < 9; ++i) {
            const float other = depth(i % 3 - 1, i / 3 - 1);
            least = std::min(least, other), most = std::max(most, other); // NaN changes neither
        }
        const float between = (cell.depth - least) * (most - cell.depth) / ((most - least) * (most - least));
        cell.share = between > 0 ? 1 - 2 * between : 1;
    }

    // s^2 of the cell.
    float spread(const Position &at) const {
        constexpr float noise = 0x1p-16f; // the steps of 8 bits: a 256th of the colour
        float sum = 0, count = 0;
        for (int i = 0; i < 9; ++i) {
            const Cell &cell = cells_[grid_.index(held(at + Imath::V2i(i % 3 - 1, i / 3 - 1)))];
            if (cell.share > 0) sum += cell.variance + noise * cell.square, ++count;
        }
        return std::max(sum / std::max(count, 1.0f), std::numeric_limits<float>::min());
    }

    void fill(const Position &at, std::span<float> result) const;

    const Windows &windows_;
    ArrayGrid grid_;
    const Axis &columns_, &rows_;
    std::array<std::span<const float>, 3> rgb_; // empty: no such channel
    std::vector<Cell> cells_;
};

// The cells around one: `side` rows of `width`, of which the last ones are unused.
struct Around {
    using Values = std::array<float, side * width>;
    Values red{}, green{}, blue{}, depth{}, slope_x{}, slope_y{}, x{}, y{}, share{}, says{}, weight{};
    std::array<std::uint8_t, side * side> order; // by `says`

    // Few change places from one pixel to the next.
    void sort() {
        for (std::size_t i = 1; i < order.size(); ++i)
            for (std::size_t k = i; k > 0 && says[order[k]] < says[order[k - 1]]; --k)
                std::swap(order[k], order[k - 1]);
    }
    float median() const {
        float half = std::accumulate(weight.begin(), weight.end(), 0.0f) / 2;
        if (!(half > 0)) return std::numeric_limits<float>::quiet_NaN();
        for (const std::uint8_t i : order)
            if ((half -= weight[i]) <= 0) return says[i];
        return says[order.back()];
    }
};

struct Pixel {
    std::array<float, 3> colour;
    float x, y; // in cells
    const float *near_x, *near_y;
};

FOR_PROCESSORS void ask(Around &cells, const Pixel &pixel, float scale) {
    for (std::size_t row = 0; row < side; ++row)
        for (std::size_t column = 0; column < width; ++column) {
            const std::size_t i = row * width + column;
            const float red = pixel.colour[0] - cells.red[i], green = pixel.colour[1] - cells.green[i],
                        blue = pixel.colour[2] - cells.blue[i];
            const float off = 1 + scale * (red * red + green * green + blue * blue);
            cells.weight[i] = cells.share[i] * pixel.near_x[column] * pixel.near_y[row] / (off * off);
            cells.says[i] = cells.depth[i] + cells.slope_x[i] * (pixel.x - cells.x[i]) +
                            cells.slope_y[i] * (pixel.y - cells.y[i]);
        }
}

void Fit::fill(const Position &at, std::span<float> result) const {
    Around cells;
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) {
            const Position place = held(at + Imath::V2i(column - reach, row - reach));
            const Cell &cell = cells_[grid_.index(place)];
            const std::size_t i = std::size_t(row) * width + std::size_t(column);
            cells.red[i] = cell.colour[0], cells.green[i] = cell.colour[1], cells.blue[i] = cell.colour[2];
            cells.depth[i] = cell.depth, cells.slope_x[i] = cell.slope_x, cells.slope_y[i] = cell.slope_y;
            cells.x[i] = float(place.column), cells.y[i] = float(place.row), cells.share[i] = cell.share;
            cells.order[std::size_t(row * side + column)] = std::uint8_t(i);
        }
    const float scale = 1 / (2 * spread(at));
    for_pixels(at, [&](std::size_t pixel, std::size_t x, std::size_t y) {
        ask(cells,
            {colour(pixel), columns_.place[x], rows_.place[y], columns_.nearness[x].data(),
             rows_.nearness[y].data()},
            scale);
        cells.sort();
        result[pixel] = cells.median();
    });
}

} // namespace

std::vector<float> fit_depth(const Image &picture, const ArrayGrid &cells, std::span<const float> depths) {
    const Windows &w = picture.windows;
    const Axis columns(w.data.min.x, w.data.max.x, w.display.min.x, w.display_width(), cells.width());
    const Axis rows(w.data.min.y, w.data.max.y, w.display.min.y, w.display_height(), cells.height());
    if (cells.width() < w.display_width() && cells.height() < w.display_height())
        return Fit(picture, cells, columns, rows, depths).medians();
    std::vector<float> result;
    result.reserve(w.pixels());
    for (const int row : rows.cell)
        for (const int column : columns.cell) result.push_back(depths[cells.index(Position(column, row))]);
    return result;
}

} // namespace sparselens
