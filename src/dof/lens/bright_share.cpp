#include "dof/lens/bright_share.h"

#include "base/parallel.h"
#include "dof/tuning.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

constexpr double cell_px = BrightShare::cell * BlockedSamples::size;
constexpr double reach = cell_px; // as far as bands of rows let highlights look (gather_rows.cpp)
constexpr double half = GatherTuning::lamp_octave;

} // namespace

int BrightShare::octave_of(float brightness) {
    return brightness > 0 ? std::clamp(std::ilogb(brightness) + octaves / 2, 0, octaves - 1) : 0;
}

BrightShare::BrightShare(const BlockedSamples &samples, const std::function<float(std::uint32_t)> &brightness)
    : samples_(samples), corners_(pieces_of(samples.columns, cell) + 1, pieces_of(samples.rows, cell) + 1),
      below_(octaves * corners_.size()) {
    const auto at = [&](int octave, int x, int y) -> double & {
        return below_[std::size_t(octave) * corners_.size() + corners_.index(x, y)];
    };
    parallel_for(std::size_t(corners_.height() - 1), [&](std::size_t row) {
        const std::size_t columns = std::size_t(samples.columns), first = row * cell * columns,
                          last = std::min(first + cell * columns, samples.blocks.size());
        for (std::size_t b = first; b < last; ++b)
            for (std::uint32_t i = samples.blocks[b].begin; i < samples.blocks[b].end; ++i)
                at(octave_of(brightness(i)), int(b % columns) / cell + 1, int(row) + 1) +=
                    double(counts_as(samples, i));
    });
    for (int octave = octaves - 2; octave >= 0; --octave)
        for (std::size_t i = 0; i < corners_.size(); ++i)
            below_[std::size_t(octave) * corners_.size() + i] +=
                below_[std::size_t(octave + 1) * corners_.size() + i];
    for (int octave = 0; octave < octaves; ++octave)
        for (int y = 1; y < corners_.height(); ++y)
            for (int x = 1; x < corners_.width(); ++x)
                at(octave, x, y) += at(octave, x - 1, y) + at(octave, x, y - 1) - at(octave, x - 1, y - 1);
}

// Counts the samples in a box of cells: {left, top, right, bottom}. A part of a cell counts as that part of its
// samples.
double BrightShare::count(int octave, const std::array<double, 4> &box) const {
    const auto before = [&](double x, double y) {
        const int column = std::min(int(x), corners_.width() - 2),
                  row = std::min(int(y), corners_.height() - 2);
        const double right = x - column, down = y - row;
        const auto at = [&](int i, int j) {
            return below_[std::size_t(octave) * corners_.size() + corners_.index(column + i, row + j)];
        };
        return (1 - down) * ((1 - right) * at(0, 0) + right * at(1, 0)) +
               down * ((1 - right) * at(0, 1) + right * at(1, 1));
    };
    return before(box[2], box[3]) - before(box[0], box[3]) - before(box[2], box[1]) + before(box[0], box[1]);
}

double BrightShare::around(std::uint32_t sample, float brightness) const {
    const auto in_cells = [&](double v, int corners) {
        return std::clamp(v / cell_px, 0.0, double(corners - 1));
    };
    const double x = double(samples_.x[sample]), y = double(samples_.y[sample]);
    const std::array box{in_cells(x - reach, corners_.width()), in_cells(y - reach, corners_.height()),
                         in_cells(x + reach, corners_.width()), in_cells(y + reach, corners_.height())};
    const double all = count(0, box);
    if (!(all > 0)) return 0;
    const double octave =
        std::clamp(std::log2(double(std::max(brightness, 1e-30f))) - half + octaves / 2, 0.0, octaves - 1.0);
    const int whole = int(octave), next = std::min(whole + 1, octaves - 1);
    return std::clamp(std::lerp(count(whole, box), count(next, box), octave - whole) / all, 0.0, 1.0);
}

} // namespace sparselens
