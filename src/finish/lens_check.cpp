#include "finish/lens_check.h"

#include "base/parallel.h"
#include "finish/tuning.h"

#include <fmt/format.h>

#include <cmath>

namespace sparselens {

namespace {

enum Change : std::size_t { gain, across, downwards, changes };

// Weighted sums over pixels: of a change squared, and times the difference of each render.
struct Fit {
    double square = 0;
    std::array<double, 2> product{0, 0};
};
struct Sums {
    std::array<Fit, changes> fits;
    double differences = 0; // of both renders, multiplied

    void add(const Sums &other) {
        for (std::size_t k = 0; k < changes; ++k) {
            fits[k].square += other.fits[k].square;
            for (std::size_t h = 0; h < 2; ++h) fits[k].product[h] += other.fits[k].product[h];
        }
        differences += other.differences;
    }
};

// What each change makes of a pixel that is not at the border.
std::array<double, changes> changed(const Values &plane, std::size_t i, std::size_t width) {
    return {double(plane[i]), double(plane[i + 1] - plane[i - 1]) / 2,
            double(plane[i + width] - plane[i - width]) / 2};
}

// Slopes beside a lamp are as bright as it is.
float brightest_around(const Colours &colours, std::size_t i, std::size_t width) {
    float brightest = brightness(colours, i);
    for (const std::size_t j : {i - 1, i + 1, i - width, i + width})
        brightest = std::max(brightest, brightness(colours, j));
    return brightest;
}

Sums sums_of_row(const LayerToFinish &layer, std::size_t row) {
    const auto width = std::size_t(layer.grid.width());
    Sums sums;
    for (std::size_t i = row * width + 1; i + 1 < (row + 1) * width; ++i) {
        const auto weight = double(seen(brightest_around(layer.gathered, i, width)));
        for (std::size_t c = 0; c < layer.gathered.size(); ++c) {
            const Values &plane = layer.gathered[c];
            const std::array difference{double(layer.rays[0][c][i] - plane[i]),
                                        double(layer.rays[1][c][i] - plane[i])};
            sums.differences += weight * difference[0] * difference[1];
            const auto change = changed(plane, i, width);
            for (std::size_t k = 0; k < changes; ++k) {
                sums.fits[k].square += weight * change[k] * change[k];
                for (std::size_t h = 0; h < 2; ++h)
                    sums.fits[k].product[h] += weight * change[k] * difference[h];
            }
        }
    }
    return sums;
}

// How much of the change the renders agree on; nothing where they do not, where it is small, or where it explains little.
std::optional<double> told(const Sums &sums, Change change, double least) {
    const Fit &fit = sums.fits[change];
    if (!(fit.square > 0) || !(sums.differences > 0)) return {};
    const double first = fit.product[0] / fit.square, second = fit.product[1] / fit.square,
                 mean = (first + second) / 2;
    const double share = first * second * fit.square / sums.differences;
    const bool agreed = std::abs(first - second) < FinishTuning::mistake_disagreement * std::abs(mean);
    if (!agreed || std::abs(mean) < least || share < FinishTuning::mistake_share) return {};
    return mean;
}

} // namespace

LensMistakes check_lens(const LayerToFinish &layer) {
    if (layer.grid.width() < 3 || layer.grid.height() < 3) return {};
    std::vector<Sums> rows(std::size_t(layer.grid.height()) - 2);
    parallel_for(rows.size(), [&](std::size_t row) { rows[row] = sums_of_row(layer, row + 1); });
    Sums sums;
    for (const Sums &row : rows) sums.add(row);
    LensMistakes found;
    if (const auto more = told(sums, gain, FinishTuning::mistake_brightness); more && *more > -1)
        found.brightness = 1 / (1 + *more);
    found.right = told(sums, across, FinishTuning::mistake_shift);
    found.down = told(sums, downwards, FinishTuning::mistake_shift);
    return found;
}

std::vector<std::string> LensMistakes::warnings() const {
    std::vector<std::string> texts;
    if (brightness)
        texts.push_back(
            fmt::format("the gathered picture is {:.2f} times as bright as the renders: give both "
                        "the same exposure and colour space",
                        *brightness));
    const auto shifted = [&](double by, const char *positive, const char *negative) {
        texts.push_back(fmt::format(
            "the gathered picture lies about {:.1f} pixels to the {} of the renders: give both the "
            "same camera, and pixels that are counted alike",
            std::abs(by), by > 0 ? positive : negative));
    };
    if (right) shifted(*right, "right", "left");
    if (down) shifted(*down, "bottom", "top");
    return texts;
}

} // namespace sparselens
