#include "finish/lens_check.h"

#include "base/numbers.h"
#include "base/parallel.h"
#include "finish/tuning.h"
#include "lens/thin_lens.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

enum Change : std::size_t { gain, across, downwards, changes };

// Weighted sums over the pixels of a block: the square of a change, and its product with the difference of each render.
struct Fit {
    double square = 0;
    std::array<double, 2> product{0, 0};
};
struct Sums {
    std::array<Fit, changes> fits;
    double differences = 0; // product of the differences of both renders
    double noise = 0;       // squared difference between the renders
};

// The value of each change at a pixel that is not at the border.
std::array<double, changes> changed(const Values &plane, std::size_t i, std::size_t width) {
    return {double(plane[i]), double(plane[i + 1] - plane[i - 1]) / 2,
            double(plane[i + width] - plane[i - width]) / 2};
}

// The brightest of a pixel and its neighbours, because slopes beside a lamp are as large as the lamp is bright.
float brightest_around(const Colours &colours, std::size_t i, std::size_t width) {
    float brightest = brightness(colours, i);
    for (const std::size_t j : {i - 1, i + 1, i - width, i + width})
        brightest = std::max(brightest, brightness(colours, j));
    return brightest;
}

Sums sums_of(const LayerToFinish &layer, const PositionBox &box) {
    const auto width = std::size_t(layer.grid.width());
    Sums sums;
    for (int y = box.min.row; y <= box.max.row; ++y)
        for (int x = box.min.column; x <= box.max.column; ++x) {
            const std::size_t i = layer.grid.index(Position(x, y));
            const auto weight = double(seen(brightest_around(layer.gathered, i, width)));
            for (std::size_t c = 0; c < layer.gathered.size(); ++c) {
                const Values &plane = layer.gathered[c];
                const std::array difference{double(layer.rays[0][c][i] - plane[i]),
                                            double(layer.rays[1][c][i] - plane[i])};
                sums.differences += weight * difference[0] * difference[1];
                sums.noise += weight * (difference[0] - difference[1]) * (difference[0] - difference[1]);
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

// How much of a change each render shows, and the change's share of their common difference from the gathered picture.
struct Told {
    std::array<double, 2> amounts{0, 0};
    double share = 0;
    double mean() const { return (amounts[0] + amounts[1]) / 2; }
};

// A mistake is the same everywhere; the errors of a gathered picture are not. So blocks count by how little difference
// remains after the change.
Told fitted(const std::vector<Sums> &blocks, Change change) {
    double noise = 0;
    for (const Sums &block : blocks) noise += block.noise;
    const double least = 1e-3 * noise / double(blocks.size()) + 1e-12;
    Told told;
    for (int pass = 0; pass < FinishTuning::mistake_passes; ++pass) {
        Fit all;
        double differences = 0;
        for (const Sums &block : blocks) {
            const Fit &fit = block.fits[change];
            const double by = told.mean();
            const double left =
                block.differences - by * (fit.product[0] + fit.product[1]) + by * by * fit.square;
            const double weight = 1 / (block.noise / 4 + std::max(left, 0.0) + least);
            all.square += weight * fit.square;
            for (std::size_t h = 0; h < 2; ++h) all.product[h] += weight * fit.product[h];
            differences += weight * block.differences;
        }
        if (!(all.square > 0) || !(differences > 0)) return {};
        for (std::size_t h = 0; h < 2; ++h) told.amounts[h] = all.product[h] / all.square;
        told.share = told.amounts[0] * told.amounts[1] * all.square / differences;
    }
    return told;
}

// The amount of the change if the renders agree on it; empty if they do not, if it is small, or if it explains little.
// Few rays miss lamps in most blocks, which then agree that there is less light. So all blocks together must show half
// of the change, too, and clearly.
std::optional<double> told(const std::vector<Sums> &blocks, Change change, double least) {
    const Told found = fitted(blocks, change);
    const double mean = found.mean();
    const auto product = [&](const Sums &block) {
        return (block.fits[change].product[0] + block.fits[change].product[1]) / 2;
    };
    double products = 0, squares = 0, variance = 0;
    for (const Sums &block : blocks) products += product(block), squares += block.fits[change].square;
    for (const Sums &block : blocks) {
        const double left = product(block) - block.fits[change].square * products / squares;
        variance += left * left;
    }
    const double deviations = FinishTuning::proof_deviations;
    if (products / mean < squares / 2 || products * products < deviations * deviations * variance) return {};
    const bool agreed =
        std::abs(found.amounts[0] - found.amounts[1]) < FinishTuning::mistake_disagreement * std::abs(mean);
    if (!agreed || std::abs(mean) < least || found.share < FinishTuning::mistake_share) return {};
    return mean;
}

} // namespace

LensMistakes check_lens(const LayerToFinish &layer) {
    if (layer.grid.width() < 3 || layer.grid.height() < 3) return {};
    // Leaves out the border, whose pixels lack neighbours.
    const PositionBox all = layer.grid.box();
    const Tiles tiles(PositionBox{all.min + Imath::V2i(1), all.max - Imath::V2i(1)},
                      FinishTuning::mistake_block_px);
    std::vector<Sums> sums(tiles.count());
    parallel_for(sums.size(), [&](std::size_t b) { sums[b] = sums_of(layer, tiles.box(b)); });
    LensMistakes found;
    if (const auto more = told(sums, gain, FinishTuning::mistake_brightness); more && *more > -1) {
        found.brightness = 1 / (1 + *more);
        return found; // slopes then cannot show whether the picture is shifted
    }
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

bool NoiseOfTwo::same() const {
    return equal >= FinishTuning::same_noise || multiple >= FinishTuning::same_multiple ||
           (equal_excess >= FinishTuning::same_excess && excess >= FinishTuning::least_excess);
}

namespace {

// The second difference along a row. NaN if it is not known.
template <typename Plane>
float bend(const Plane &plane, std::size_t i) {
    return float(plane[i]) - (float(plane[i - 1]) + float(plane[i + 1])) / 2;
}

// Counts pairs of pixels that are a few pixels apart: all pairs, those in which both pixels are brighter in the same
// render, and how many of these to expect by chance.
struct Directions {
    std::size_t same = 0, all = 0;
    double expected = 0;
};

// Adds the pairs of each pixel of a block with the pixel whose index is smaller by `apart`.
void add_directions(const Values &a, const Values &b, const ArrayGrid &grid, const PositionBox &box,
                    std::size_t apart, Directions &sum) {
    std::size_t all = 0, same = 0, up = 0, other_up = 0;
    for (int y = box.min.row; y <= box.max.row; ++y)
        for (int x = box.min.column; x <= box.max.column; ++x) {
            const std::size_t i = grid.index(Position(x, y)), j = i - apart;
            const float here = a[i] - b[i], there = a[j] - b[j];
            if (here == 0 || there == 0 || !std::isfinite(here + there)) continue;
            ++all;
            same += (here > 0) == (there > 0);
            up += here > 0;
            other_up += there > 0;
        }
    if (all == 0) return;
    const double p = double(up) / double(all), q = double(other_up) / double(all);
    sum.all += all;
    sum.same += same;
    sum.expected += double(all) * (p * q + (1 - p) * (1 - q));
}

// The share of pairs that agree, less what chance explains: the expected share and four standard deviations.
double agreement(const Values &a, const Values &b, const ArrayGrid &grid) {
    constexpr int apart = FinishTuning::noise_apart;
    Directions sum;
    for (const Imath::V2i &by : {Imath::V2i(apart, 0), Imath::V2i(0, apart)}) {
        if (grid.width() <= by.x || grid.height() <= by.y) continue;
        const PositionBox later{grid.box().min + by, grid.box().max};
        const Tiles tiles(later, FinishTuning::block_px);
        for (std::size_t t = 0; t < tiles.count(); ++t)
            add_directions(a, b, grid, tiles.box(t), grid.index(later.min), sum);
    }
    if (sum.all == 0) return 0;
    return (double(sum.same) - sum.expected) / double(sum.all) - 2 / std::sqrt(double(sum.all));
}

// The share of the first render in the noise, the median over blocks; 1/2 if nothing tells.
double noise_of_first(const Values &first, const Values &second, const Values &gathered,
                      const ArrayGrid &grid) {
    if (grid.width() < 3) return 0.5;
    const PositionBox whole = grid.box();
    const Tiles tiles(PositionBox{whole.min + Imath::V2i(1, 0), whole.max - Imath::V2i(1, 0)},
                      FinishTuning::noise_block_px);
    std::vector<double> shares;
    for (std::size_t b = 0; b < tiles.count(); ++b) {
        const PositionBox box = tiles.box(b);
        double own = 0, all = 0;
        for (int y = box.min.row; y <= box.max.row; ++y)
            for (int x = box.min.column; x <= box.max.column; ++x) {
                const std::size_t i = grid.index(Position(x, y));
                const double one = double(bend(first, i)), apart = one - double(bend(second, i)),
                             product = (one - double(bend(gathered, i))) * apart;
                if (!std::isfinite(product) || !std::isfinite(apart)) continue;
                own += product;
                all += apart * apart;
            }
        if (all > 0) shares.push_back(own / all);
    }
    return shares.empty() ? 0.5 : median(shares);
}

// How often the difference of two renders bends as the second one does: 1 if the first is a multiple of it. Independent
// noise is in the second render and, with the other sign, in the difference, so they agree in half of the pixels at
// most, however wrong a gathered picture is. Bends up and down count alike, because bright noise bends both more often
// down than up.
class Multiple {
public:
    void add(float second, float difference) {
        if (!std::isfinite(second + difference) || second == 0 || difference == 0) return;
        ++all_[second > 0];
        agreed_[second > 0] += (second > 0) == (difference > 0);
    }
    // Less four standard deviations.
    double share() const {
        const double up = double(all_[1]), down = double(all_[0]);
        if (up == 0 || down == 0) return 0;
        return (double(agreed_[1]) / up + double(agreed_[0]) / down) / 2 - std::sqrt(1 / up + 1 / down);
    }

private:
    std::array<std::size_t, 2> all_{0, 0}, agreed_{0, 0}; // of bends down and up
};

Values mapped(std::span<const half> values) {
    Values result(values.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
        const float v = values[i];
        result[i] = v >= 0 ? v / (1 + v) : std::min(v, 0.0f);
    }
    return result;
}

} // namespace

NoiseOfTwo noise_of_two(std::span<const half> first, std::span<const half> second,
                        std::span<const half> gathered, const ArrayGrid &grid) {
    const Values a = mapped(first), b = mapped(second), g = mapped(gathered);
    const auto width = std::size_t(grid.width());
    std::size_t told = 0, equal = 0, excess = 0, equal_excess = 0;
    std::array<Multiple, 2> multiple;
    for (std::size_t i = 1; i + 1 < a.size(); ++i) {
        if (std::abs(a[i] - a[i - 1]) > 0 && std::isfinite(b[i])) { // both are known
            ++told;
            equal += a[i] == b[i];
        }
        const float bent = bend(a, i);
        const bool inside = i % width > 0 && (i + 1) % width > 0;
        if (inside) {
            const float one = bend(first, i), two = bend(second, i);
            multiple[0].add(two, one - two);
            multiple[1].add(one, two - one);
        }
        if (!inside || !(a[i] > a[i - 1] && a[i] > a[i + 1] && bent > FinishTuning::rough * std::abs(a[i]) &&
                         bent > 2 * std::abs(bend(g, i))))
            continue;
        ++excess;
        equal_excess += a[i] == b[i];
    }
    const auto share = [](std::size_t part, std::size_t all) {
        return all > 0 ? double(part) / double(all) : 0;
    };
    NoiseOfTwo found{share(equal, told),          share(excess, a.size()),
                     share(equal_excess, excess), std::max(multiple[0].share(), multiple[1].share()),
                     agreement(a, b, grid),       {}};
    const double of_first = noise_of_first(a, b, g, grid);
    found.of_each = {of_first, 1 - of_first};
    return found;
}

namespace {

bool differ(double a, double b) {
    return a != b && std::abs(a - b) >= FinishTuning::lens_difference * std::max(std::abs(a), std::abs(b));
}

// The radius of the aperture, mm.
std::optional<double> radius_mm(const Camera &camera) {
    if (!camera.focal_length_mm || !camera.fstop) return {};
    return radius_of(*camera.fstop, *camera.focal_length_mm, 1e-3);
}

std::optional<double> focus_metres(const Camera &camera) {
    if (!camera.focus_distance) return {};
    return *camera.focus_distance * camera.metres_per_unit.value_or(1);
}

// Between 0 and half a side of the polygon, degrees.
double turned(double a, double b, double blades) { return std::abs(std::remainder(a - b, 360 / blades)); }

std::string with_blades(double blades) {
    return blades > 0 ? fmt::format("{:g} blades", blades) : std::string("no blades");
}

// Whether two matrices differ by more than the rounding of floats.
bool differ(const Imath::M44d &a, const Imath::M44d &b) {
    double largest = 1;
    for (int i = 0; i < 16; ++i) largest = std::max(largest, std::abs(a.getValue()[i]));
    return !a.equalWithAbsError(b, 1e-5 * largest);
}

} // namespace

std::vector<std::string> lens_differences(const Camera &gathered, const Camera &render) {
    std::vector<std::string> found;
    const auto radius = radius_mm(gathered), other_radius = radius_mm(render);
    if (radius && other_radius && differ(*radius, *other_radius))
        found.push_back(fmt::format("an aperture of {:.4g} mm radius, not {:.4g}", *other_radius, *radius));
    const auto focus = focus_metres(gathered), other_focus = focus_metres(render);
    if (focus && other_focus && differ(*focus, *other_focus))
        found.push_back(fmt::format("focus at {:.4g} m, not {:.4g}", *other_focus, *focus));
    if (gathered.world_to_camera && render.world_to_camera &&
        differ(*gathered.world_to_camera, *render.world_to_camera))
        found.emplace_back("a camera that stands or looks elsewhere (worldToCamera)");
    const auto focal = focal_length_px(gathered, 1), other_focal = focal_length_px(render, 1);
    if (focal && other_focal && differ(*focal, *other_focal))
        found.push_back(
            fmt::format("a focal length of {:.4g} widths of the picture, not {:.4g}", *other_focal, *focal));
    if (gathered.principal_point && render.principal_point &&
        (*gathered.principal_point - *render.principal_point).length() > FinishTuning::axis_difference)
        found.emplace_back("a lens shifted elsewhere");
    const LookValues &looks = gathered.looks, &other = render.looks;
    const double squeeze = looks.squeeze.value_or(1), other_squeeze = other.squeeze.value_or(squeeze);
    if (differ(squeeze, other_squeeze))
        found.push_back(fmt::format("a squeeze of {:.4g}, not {:.4g}", other_squeeze, squeeze));
    if (!looks.blades || !other.blades) return found;
    const double blades = *looks.blades, rotation = looks.rotation.value_or(0),
                 other_rotation = other.rotation.value_or(0);
    if (blades != *other.blades)
        found.push_back(with_blades(*other.blades) + ", not " + with_blades(blades));
    else if (blades > 0 && turned(rotation, other_rotation, blades) > FinishTuning::turned_degrees)
        found.push_back(fmt::format("blades turned by {:.4g} degrees, not {:.4g}", other_rotation, rotation));
    return found;
}

} // namespace sparselens
