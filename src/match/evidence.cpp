#include "match/evidence.h"

#include "match/tuning.h"

#include <algorithm>

namespace sparselens {

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
