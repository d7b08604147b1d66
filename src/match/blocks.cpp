#include "match/blocks.h"

#include "base/light.h"
#include "base/parallel.h"
#include "match/tuning.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

constexpr std::size_t nuisances = 7, first_tint = 5; // 1, V, V^2, V_x, V_y, R - V, B - V
using Row = std::array<double, nuisances + 1>;       // of a pixel: the nuisances, the plate

// Sums of products of the columns; the last column is the plate. The matrix is symmetric: its upper half is kept.
template <std::size_t columns>
struct Products {
    std::array<std::array<double, columns>, columns> of{};

    void add(const std::array<double, columns> &row, double weight) {
        for (std::size_t i = 0; i < columns; ++i) {
            const double value = weight * row[i];
            for (std::size_t k = i; k < columns; ++k) of[i][k] += value * row[k];
        }
    }
    // Takes out of all later columns what column `i` explains of them.
    void sweep(std::size_t i, double least) {
        if (!(of[i][i] > least)) return;
        for (std::size_t j = i + 1; j < columns; ++j) {
            const double share = of[i][j] / of[i][i];
            for (std::size_t k = j; k < columns; ++k) of[j][k] -= share * of[i][k];
        }
    }
    double plate() const { return of[columns - 1][columns - 1]; }
};

// A fit whose errors have heavy tails: Student's t distribution, fitted by expectation and maximisation (Lange, Little
// and Taylor 1989). So the few pixels at which the gathered picture is wrong, such as a gap in the LDI, hardly count.
struct Robust {
    std::vector<double> weights; // [pixel]
    std::array<double, nuisances> by{};
    double ridge = 0; // of the colours
    double variance = 0, likelihood = 0;
};

// Fewer pixels than this say nothing about so many unknowns.
constexpr int least_pixels = 3 * int(nuisances + most_changes + 1);

double least_of(double diagonal, double pixels) { return 1e-4 * diagonal + 1e-12 * pixels; }

// Finds the coefficients of the nuisances. The colours count only as far as they explain more than noise, because in a
// grey block they would explain blur.
template <std::size_t columns>
void solve(Products<columns> sums, double pixels, Robust &fit) {
    constexpr std::size_t plate = columns - 1;
    std::array<double, plate> least{};
    for (std::size_t i = 0; i < plate; ++i) least[i] = least_of(sums.of[i][i], pixels);
    for (std::size_t i = 0; i < plate; ++i) {
        if (i == first_tint) fit.ridge = MatchTuning::tint_ridge * sums.plate() / pixels;
        if (i >= first_tint) sums.of[i][i] += fit.ridge;
        sums.sweep(i, least[i]);
    }
    fit.by = {};
    for (std::size_t i = plate; i-- > 0;) {
        if (!(sums.of[i][i] > least[i])) continue;
        double value = sums.of[i][plate];
        for (std::size_t k = i + 1; k < plate; ++k) value -= sums.of[i][k] * fit.by[k];
        fit.by[i] = value / sums.of[i][i];
    }
}

// Fits the plate by the first nuisances, `used` of them.
template <std::size_t used>
Robust robust_fit(const std::vector<Row> &rows) {
    constexpr double tails = MatchTuning::tails, least = MatchTuning::least_error * MatchTuning::least_error;
    const auto pixels = double(rows.size());
    Robust fit;
    fit.weights.assign(rows.size(), 1);
    std::vector<double> squares(rows.size());
    for (int pass = 0; pass < MatchTuning::robust_fits; ++pass) {
        Products<used + 1> sums;
        for (std::size_t p = 0; p < rows.size(); ++p) {
            std::array<double, used + 1> row;
            std::copy_n(rows[p].begin(), used, row.begin());
            row[used] = rows[p].back();
            sums.add(row, fit.weights[p]);
        }
        solve(sums, pixels, fit);
        double sum = 0;
        for (std::size_t p = 0; p < rows.size(); ++p) {
            double off = rows[p].back();
            for (std::size_t i = 0; i < used; ++i) off -= fit.by[i] * rows[p][i];
            squares[p] = off * off;
            sum += fit.weights[p] * squares[p];
        }
        fit.variance = sum / pixels + least;
        for (std::size_t p = 0; p < rows.size(); ++p)
            fit.weights[p] = (tails + 1) / (tails + squares[p] / fit.variance);
    }
    fit.likelihood = -0.5 * pixels * std::log(fit.variance);
    for (const double square : squares)
        fit.likelihood -= 0.5 * (tails + 1) * std::log1p(square / (tails * fit.variance));
    return fit;
}

// The pixels of a block.
class Block {
public:
    Block(const Grey &plate, std::span<const std::uint8_t> usable, const Rgb &gathered,
          std::span<const Rgb> changes, const Imath::Box2i &box)
        : plate_(plate), usable_(usable), gathered_(gathered), changes_(changes), box_(box) {}

    BlockFit fit() {
        int count = 0;
        for_each([&](std::size_t, int x, int y) { middle_ += value(x, y), ++count; });
        BlockFit result;
        if (count < int(MatchTuning::least_share * double(Grid(box_).size())) || count < least_pixels)
            return result;
        middle_ /= count;
        std::vector<Row> rows;
        rows.reserve(std::size_t(count));
        for_each([&](std::size_t i, int x, int y) { rows.push_back(row(i, x, y)); });
        const Robust flat = robust_fit<1>(rows), fit = robust_fit<nuisances>(rows);
        result.pixels = count;
        result.before = flat.variance;
        result.left = fit.variance;
        result.likelihood = fit.likelihood - flat.likelihood;
        if (std::abs(fit.by[1]) > 1e-6) {
            result.shift_x = -fit.by[3] / fit.by[1];
            result.shift_y = -fit.by[4] / fit.by[1];
        }
        if (!changes_.empty()) measure_changes(rows, fit, result);
        return result;
    }

private:
    template <typename Each>
    void for_each(const Each &each) const {
        for (int y = box_.min.y; y <= box_.max.y; ++y)
            for (int x = box_.min.x; x <= box_.max.x; ++x) {
                const std::size_t i = gathered_.grid.index(Imath::V2i(x, y));
                if (usable_[i]) each(i, x, y);
            }
    }

    // The mean of R, G and B; the border repeats beyond it.
    double value(int x, int y) const {
        const Imath::Box2i all = gathered_.grid.box();
        const std::size_t i = gathered_.grid.index(
            Imath::V2i(std::clamp(x, all.min.x, all.max.x), std::clamp(y, all.min.y, all.max.y)));
        return double(gathered_.rgb[0][i] + gathered_.rgb[1][i] + gathered_.rgb[2][i]) / 3;
    }

    Row row(std::size_t i, int x, int y) const {
        const double v = value(x, y), off = v - middle_;
        return {1,
                off,
                off * off,
                (value(x + 1, y) - value(x - 1, y)) / 2,
                (value(x, y + 1) - value(x, y - 1)) / 2,
                double(gathered_.rgb[0][i]) - v,
                double(gathered_.rgb[2][i]) - v,
                double(plate_.values[i])};
    }

    // Fits again, with the changes as the plate would show them.
    void measure_changes(const std::vector<Row> &rows, const Robust &fit, BlockFit &result) const {
        constexpr std::size_t plate = nuisances + most_changes;
        Products<plate + 1> sums;
        std::size_t p = 0;
        for_each([&](std::size_t i, int, int) {
            std::array<double, plate + 1> row{};
            std::copy_n(rows[p].begin(), nuisances, row.begin());
            row[plate] = rows[p].back();
            for (std::size_t c = 0; c < changes_.size(); ++c) {
                const auto &rgb = changes_[c].rgb;
                const double of_v = double(rgb[0][i] + rgb[1][i] + rgb[2][i]) / 3;
                row[nuisances + c] = (fit.by[1] + 2 * fit.by[2] * row[1]) * of_v +
                                     fit.by[5] * (double(rgb[0][i]) - of_v) +
                                     fit.by[6] * (double(rgb[2][i]) - of_v);
            }
            sums.add(row, fit.weights[p++]);
        });
        for (std::size_t i = 0; i < nuisances; ++i) {
            const double least = least_of(sums.of[i][i], double(rows.size()));
            if (i >= first_tint) sums.of[i][i] += fit.ridge;
            sums.sweep(i, least);
        }
        for (std::size_t i = 0; i < most_changes; ++i) {
            result.pull[i] = sums.of[nuisances + i][plate];
            for (std::size_t k = 0; k < most_changes; ++k)
                result.stiffness[i][k] = sums.of[nuisances + std::min(i, k)][nuisances + std::max(i, k)];
        }
    }

    const Grey &plate_;
    std::span<const std::uint8_t> usable_;
    const Rgb &gathered_;
    std::span<const Rgb> changes_;
    Imath::Box2i box_;
    double middle_ = 0; // of V
};

} // namespace

std::vector<BlockFit> fit_blocks(const Grey &plate, std::span<const std::uint8_t> usable, const Rgb &gathered,
                                 std::span<const Rgb> changes) {
    const Tiles tiles(plate.grid.box(), MatchTuning::compared_block_px);
    std::vector<BlockFit> fits(tiles.count());
    parallel_for(tiles.count(), [&](std::size_t i) {
        fits[i] = Block(plate, usable, gathered, changes, tiles.box(i)).fit();
    });
    return fits;
}

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
                    return of.rgb[k][of.grid.index(Imath::V2i(std::clamp(x + dx, box.min.x, box.max.x),
                                                              std::clamp(y + dy, box.min.y, box.max.y)))];
                };
                const std::size_t i = of.grid.index(Imath::V2i(x, y));
                along.rgb[k][i] = (at(1, 0) + at(-1, 0) - at(0, 1) - at(0, -1)) / 4;
                across.rgb[k][i] = (at(1, 1) + at(-1, -1) - at(1, -1) - at(-1, 1)) / 8;
            }
    return {std::move(along), std::move(across)};
}

namespace {

int wrapped(int at, int size) { return ((at % size) + size) % size; }

// The values moved by some pixels; what leaves the picture enters on the other side.
template <typename Values>
Values moved(const Values &values, const Grid &grid, int dx, int dy) {
    Values result(values.size());
    const int width = grid.width(), height = grid.height();
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            result[std::size_t(y) * std::size_t(width) + std::size_t(x)] =
                values[std::size_t(wrapped(y + dy, height)) * std::size_t(width) +
                       std::size_t(wrapped(x + dx, width))];
    return result;
}

} // namespace

Evidence find_evidence(const Grey &plate, std::span<const std::uint8_t> usable, const Rgb &gathered) {
    using Fits = std::vector<BlockFit>;
    const Fits here = fit_blocks(plate, usable, gathered, {});
    const std::vector<std::uint8_t> mask(usable.begin(), usable.end());
    std::vector<Fits> elsewhere;
    for (const auto &[dx, dy] : MatchTuning::other_places)
        elsewhere.push_back(fit_blocks({plate.grid, moved(plate.values, plate.grid, dx, dy)},
                                       moved(mask, plate.grid, dx, dy), gathered, {}));
    Evidence found;
    for (std::size_t i = 0; i < here.size(); ++i) {
        const BlockFit &block = here[i];
        if (block.pixels == 0) continue;
        const auto left_share = [](const BlockFit &fit) {
            return fit.before > 0 ? fit.left / fit.before : 1;
        };
        double best_elsewhere = 1;
        for (const Fits &other : elsewhere) best_elsewhere = std::min(best_elsewhere, left_share(other[i]));
        const double left = left_share(block);
        if (std::min(left, best_elsewhere) > 1 - MatchTuning::explained) continue;
        ++found.textured;
        found.matched += left < best_elsewhere ? 1 : 0;
    }
    return found;
}

} // namespace sparselens
