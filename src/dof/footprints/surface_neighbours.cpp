#include "dof/footprints/surface_neighbours.h"

#include "dof/tuning.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

constexpr double whole = GatherTuning::neighbours_whole * one_surface_px;

// Returns the sample of a pixel that is nearest to a depth, planar `z` and perceptive `depth`. In a stack of mist and
// sheets, several samples may be within reach.
std::uint64_t surface_in(const Ldi &ldi, const ThinLens &lens, int x, int y, float z, double depth) {
    const int width = ldi.windows.width();
    if (x < 0 || y < 0 || x >= width || y >= ldi.windows.height()) return no_neighbour;
    const SampleRange samples = ldi.pixel(std::size_t(y) * std::size_t(width) + std::size_t(x));
    const auto distance = [&](std::uint64_t i) {
        return std::abs(perceptive_depth(lens, double(ldi.z[i])) - depth);
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
    const double depth = perceptive_depth(lens, double(ldi.z[i]));
    const auto beside = [&](int dx, int dy) {
        return surface_in(ldi, lens, x + dx, y + dy, ldi.z[i], depth);
    };
    SurfaceNeighbours n{{beside(-1, 0), beside(1, 0), beside(0, -1), beside(0, 1)}, 0, 0};
    const auto shown = [&](std::uint64_t a, std::uint64_t b) {
        if (a == no_neighbour || b == no_neighbour) return 0.0f;
        const auto apart = [&](std::uint64_t k) {
            return std::abs(perceptive_depth(lens, double(ldi.z[k])) - depth);
        };
        return float(
            std::min((one_surface_px - std::max(apart(a), apart(b))) / (one_surface_px - whole), 1.0));
    };
    n.horizontal = shown(n.sample[0], n.sample[1]);
    n.vertical = shown(n.sample[2], n.sample[3]);
    return n;
}

} // namespace sparselens
