#include "dof/footprints/interpolation_blur.h"

#include "dof/tuning.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

// How much light passes the lens in each of its columns, side by side from -1 to 1; along the other axis, in each of
// its rows.
using LensColumns = std::array<double, 64>;

double middle_of_column(std::size_t i) { return (double(i) + 0.5) * 2 / std::tuple_size<LensColumns>() - 1; }

// Over the disc, a column at x has a height of sqrt(1 - x^2).
LensColumns disc_columns() {
    LensColumns columns;
    for (std::size_t i = 0; i < columns.size(); ++i)
        columns[i] = std::sqrt(1 - middle_of_column(i) * middle_of_column(i));
    return columns;
}

// The columns before the aperture is squeezed. They are symmetric, because tables do not tell on which side of the grid
// a sample lies.
LensColumns columns_of(const Aperture &aperture, bool behind, bool vertical) {
    constexpr int n = 128;
    LensColumns columns{};
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const LensPoint point = aperture.at(Imath::V2d(i + 0.5, j + 0.5) / n);
            const double x = vertical ? point.u.y : point.u.x * aperture.shape().squeeze;
            const double column = (x + 1) / 2 * double(columns.size());
            const auto at = std::size_t(std::clamp(column, 0.0, double(columns.size() - 1)));
            const double weight = point.side(behind, 1); // the rims of G stand for all
            columns[at] += weight;
            columns[columns.size() - 1 - at] += weight;
        }
    return columns;
}

} // namespace

// Weights for one axis, by the CoC and the offset of a sample.
class InterpolationBlur::Table {
public:
    explicit Table(const LensColumns &columns) {
        for (int c = 0; c < cocs; ++c)
            for (int o = 0; o < offsets; ++o)
                table_[std::size_t(c * offsets + o)] = mean(columns, coc_at(c), offset_at(o));
    }
    // Half of the mean, which is the weight of the second difference; fades out towards the largest CoC.
    double weight(double coc, double offset) const {
        coc = std::abs(coc);
        if (!(coc < GatherTuning::interpolated_px)) return 0;
        // Interpolates between entries; a sample in focus on the grid must get exactly 0.
        const double u = coc / GatherTuning::interpolated_px * (cocs - 1),
                     v = std::min(std::abs(offset) * 2, 1.0) * (offsets - 1);
        const int c = std::min(int(u), cocs - 2), o = std::min(int(v), offsets - 2);
        const auto along = [&](int row) { return std::lerp(entry(row, o), entry(row, o + 1), v - o); };
        return 0.5 * std::lerp(along(c), along(c + 1), u - c) *
               std::min(1.0, 2 * (1 - coc / GatherTuning::interpolated_px));
    }

private:
    static constexpr int cocs = 128, offsets = 16;
    static double coc_at(int c) { return c * GatherTuning::interpolated_px / (cocs - 1); }
    static double offset_at(int o) { return o * 0.5 / (offsets - 1); }
    double entry(int c, int o) const { return table_[std::size_t(c * offsets + o)]; }
    static double mean(const LensColumns &columns, double coc, double offset) {
        double sum = 0, area = 0;
        for (std::size_t i = 0; i < columns.size(); ++i) {
            const double place = offset + coc * middle_of_column(i), f = place - std::floor(place);
            sum += columns[i] * f * (1 - f);
            area += columns[i];
        }
        return sum / area;
    }
    std::array<double, std::size_t(cocs) * offsets> table_{};
};

InterpolationBlur::InterpolationBlur(const Aperture *aperture)
    : squeeze_(aperture ? aperture->shape().squeeze : 1) {
    if (!aperture || aperture->disc()) {
        tables_.emplace_back(disc_columns());
        return;
    }
    for (const bool behind : {false, true})
        for (const bool vertical : {false, true})
            tables_.emplace_back(columns_of(*aperture, behind, vertical));
}

InterpolationBlur::~InterpolationBlur() = default;

bool InterpolationBlur::any(double least, double most, double pixel_aspect) const {
    const double smallest = least <= 0 && most >= 0 ? 0 : std::min(std::abs(least), std::abs(most));
    return smallest * std::min(1 / squeeze_, pixel_aspect) <
           GatherTuning::interpolated_px + 1e-3; // CoCs are rounded
}

double InterpolationBlur::horizontal(double coc, double offset) const {
    return of(coc, 0).weight(coc / squeeze_, offset);
}

double InterpolationBlur::vertical(double coc, double offset) const { return of(coc, 1).weight(coc, offset); }

const InterpolationBlur::Table &InterpolationBlur::of(double coc, std::size_t axis) const {
    return tables_.size() == 1 ? tables_[0] : tables_[(coc > 0 ? 2 : 0) + axis];
}

namespace {

constexpr double whole = GatherTuning::neighbours_whole * one_surface_px;

// Returns the sample of a pixel that is nearest to a depth, planar `z` and disparity `depth`. In a stack of mist and
// sheets, several samples may be within reach.
std::uint64_t surface_in(const Ldi &ldi, const ThinLens &lens, int x, int y, float z, double depth) {
    const int width = ldi.windows.width();
    if (x < 0 || y < 0 || x >= width || y >= ldi.windows.height()) return no_neighbour;
    const SampleRange samples = ldi.pixel(std::size_t(y) * std::size_t(width) + std::size_t(x));
    const auto distance = [&](std::uint64_t i) {
        return std::abs(disparity(lens, double(ldi.z[i])) - depth);
    };
    if (samples.size() == 1) return distance(samples.from) < one_surface_px ? samples.from : no_neighbour;
    const auto first = ldi.z.begin() + std::ptrdiff_t(samples.from);
    const auto behind =
        samples.from +
        std::uint64_t(std::lower_bound(first, first + std::ptrdiff_t(samples.size()), z) - first);
    std::uint64_t found = no_neighbour;
    double least = one_surface_px;
    for (std::uint64_t i = std::max(behind, samples.from + 1) - 1; i < std::min(behind + 1, samples.to);
         ++i) {
        const double apart = distance(i);
        if (apart >= least) continue;
        found = i;
        least = apart;
    }
    return found;
}

} // namespace

SurfaceNeighbours surface_neighbours(const Ldi &ldi, const ThinLens &lens, std::uint64_t i, int x, int y) {
    const double depth = disparity(lens, double(ldi.z[i]));
    const auto beside = [&](int dx, int dy) {
        return surface_in(ldi, lens, x + dx, y + dy, ldi.z[i], depth);
    };
    SurfaceNeighbours n{{beside(-1, 0), beside(1, 0), beside(0, -1), beside(0, 1)}, 0, 0};
    const auto shown = [&](std::uint64_t a, std::uint64_t b) {
        if (a == no_neighbour || b == no_neighbour) return 0.0f;
        const auto apart = [&](std::uint64_t k) {
            return std::abs(disparity(lens, double(ldi.z[k])) - depth);
        };
        return float(
            std::min((one_surface_px - std::max(apart(a), apart(b))) / (one_surface_px - whole), 1.0));
    };
    n.horizontal = shown(n.sample[0], n.sample[1]);
    n.vertical = shown(n.sample[2], n.sample[3]);
    return n;
}

} // namespace sparselens
