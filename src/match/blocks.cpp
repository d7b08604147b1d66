#include "match/blocks.h"

#include "base/parallel.h"
#include "match/tuning.h"

#include <cmath>

namespace sparselens {

namespace {

constexpr std::size_t nuisances = 7, first_tint = 5; // 1, V, V^2, V_x, V_y, R - V, B - V
constexpr std::size_t columns = nuisances + most_changes + 1;
using Row = std::array<double, columns>; // of a pixel: the nuisances, the changes, the plate

constexpr std::size_t plate_column = columns - 1;

struct Products {
    std::array<Row, columns> of{};

    void add(const Row &row) {
        for (std::size_t i = 0; i < columns; ++i)
            for (std::size_t k = i; k < columns; ++k) of[i][k] += row[i] * row[k];
    }
    // Takes out of all later columns what column `i` explains of them.
    void sweep(std::size_t i, double least) {
        if (!(of[i][i] > least)) return;
        for (std::size_t j = i + 1; j < columns; ++j) {
            const double share = of[i][j] / of[i][i];
            for (std::size_t k = j; k < columns; ++k) of[j][k] -= share * of[i][k];
        }
    }
};

// The pixels of a block.
class Block {
public:
    Block(const Grey &plate, std::span<const std::uint8_t> usable, const Colours &gathered,
          std::span<const Colours> changes, const Imath::Box2i &box)
        : plate_(plate), usable_(usable), gathered_(gathered), changes_(changes), box_(box) {}

    BlockFit fit() {
        for_each([&](std::size_t, int x, int y) { middle_ += value(x, y), ++count_; });
        BlockFit result;
        if (count_ < int(MatchTuning::least_share * double(Grid(box_).size())) || count_ < 3 * int(columns))
            return result;
        middle_ /= count_;
        Products first;
        for_each([&](std::size_t i, int x, int y) { first.add(row(i, x, y, false)); });
        result.pixels = count_;
        const double mean = first.of[0][plate_column] / count_;
        result.before = first.of[plate_column][plate_column] - count_ * mean * mean;
        // The coefficients of the nuisances, by elimination and substitution. The colours count only as far as they
        // explain more than noise, because in a grey block they would explain blur.
        std::array<double, nuisances> least{};
        for (std::size_t i = 0; i < nuisances; ++i) least[i] = 1e-4 * first.of[i][i] + 1e-12 * count_;
        double ridge = 0;
        for (std::size_t i = 0; i < nuisances; ++i) {
            if (i == first_tint)
                ridge = MatchTuning::tint_ridge * first.of[plate_column][plate_column] / count_;
            if (i >= first_tint) first.of[i][i] += ridge;
            first.sweep(i, least[i]);
        }
        std::array<double, nuisances> by{};
        for (std::size_t i = nuisances; i-- > 0;) {
            if (!(first.of[i][i] > least[i])) continue;
            double value = first.of[i][plate_column];
            for (std::size_t k = i + 1; k < nuisances; ++k) value -= first.of[i][k] * by[k];
            by[i] = value / first.of[i][i];
        }
        result.left = std::max(first.of[plate_column][plate_column], 0.0);
        if (std::abs(by[1]) > 1e-6) {
            result.shift_x = -by[3] / by[1];
            result.shift_y = -by[4] / by[1];
        }
        if (changes_.empty()) return result;
        // Again, with the changes as the plate would show them.
        by_ = by;
        Products second;
        for_each([&](std::size_t i, int x, int y) { second.add(row(i, x, y, true)); });
        for (std::size_t i = 0; i < nuisances; ++i) {
            if (i >= first_tint) second.of[i][i] += ridge;
            second.sweep(i, least[i]);
        }
        for (std::size_t i = 0; i < most_changes; ++i) {
            result.pull[i] = second.of[nuisances + i][plate_column];
            for (std::size_t k = 0; k < most_changes; ++k)
                result.stiffness[i][k] = second.of[nuisances + std::min(i, k)][nuisances + std::max(i, k)];
        }
        return result;
    }

private:
    template <typename Each>
    void for_each(const Each &each) const {
        for (int y = box_.min.y; y <= box_.max.y; ++y)
            for (int x = box_.min.x; x <= box_.max.x; ++x) {
                const std::size_t i = gathered_.grid.index(x, y);
                if (usable_[i]) each(i, x, y);
            }
    }

    // The mean of R, G and B; the border repeats beyond it.
    double value(int x, int y) const {
        const Imath::Box2i all = gathered_.grid.box();
        const std::size_t i =
            gathered_.grid.index(std::clamp(x, all.min.x, all.max.x), std::clamp(y, all.min.y, all.max.y));
        return double(gathered_.rgb[0][i] + gathered_.rgb[1][i] + gathered_.rgb[2][i]) / 3;
    }

    Row row(std::size_t i, int x, int y, bool with_changes) const {
        const double v = value(x, y), off = v - middle_;
        Row row{1,
                off,
                off * off,
                (value(x + 1, y) - value(x - 1, y)) / 2,
                (value(x, y + 1) - value(x, y - 1)) / 2,
                double(gathered_.rgb[0][i]) - v,
                double(gathered_.rgb[2][i]) - v};
        row[plate_column] = double(plate_.values[i]);
        if (!with_changes) return row;
        for (std::size_t c = 0; c < changes_.size(); ++c) {
            const auto &rgb = changes_[c].rgb;
            const double of_v = double(rgb[0][i] + rgb[1][i] + rgb[2][i]) / 3;
            row[nuisances + c] = (by_[1] + 2 * by_[2] * off) * of_v + by_[5] * (double(rgb[0][i]) - of_v) +
                                 by_[6] * (double(rgb[2][i]) - of_v);
        }
        return row;
    }

    const Grey &plate_;
    std::span<const std::uint8_t> usable_;
    const Colours &gathered_;
    std::span<const Colours> changes_;
    Imath::Box2i box_;
    double middle_ = 0; // of V
    int count_ = 0;
    std::array<double, nuisances> by_{};
};

double floor_of(int pixels) { return pixels * MatchTuning::least_error * MatchTuning::least_error; }

} // namespace

double BlockFit::likelihood() const {
    if (pixels == 0) return 0;
    return -0.5 * pixels * std::log((left + floor_of(pixels)) / (before + floor_of(pixels)));
}

double BlockFit::noise() const {
    return pixels == 0 ? 1 : (left + floor_of(pixels)) / double(pixels - int(nuisances));
}

std::vector<BlockFit> fit_blocks(const Grey &plate, std::span<const std::uint8_t> usable,
                                 const Colours &gathered, std::span<const Colours> changes) {
    const Tiles tiles(plate.grid.box(), MatchTuning::compared_block_px);
    std::vector<BlockFit> fits(tiles.count());
    parallel_for(tiles.count(), [&](std::size_t i) {
        fits[i] = Block(plate, usable, gathered, changes, tiles.box(i)).fit();
    });
    return fits;
}

} // namespace sparselens
