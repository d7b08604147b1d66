#include "finish/fireflies.h"

#include "base/parallel.h"
#include "finish/tuning.h"
#include "finish/window_means.h"

#include <algorithm>
#include <array>
#include <utility>

namespace sparselens {

namespace {

// The largest values, the greatest first.
struct Largest {
    std::array<float, FinishTuning::firefly_rank> values{};
    void add(float v) {
        for (float &of : values)
            if (v > of) std::swap(v, of);
    }
};

void add_around(const Colours &colours, const ArrayGrid &grid, const Position &at, int radius,
                Largest &largest) {
    const Position last = grid.box().max;
    for (int y = std::max(at.row - radius, 0); y <= std::min(at.row + radius, last.row); ++y)
        for (int x = std::max(at.column - radius, 0); x <= std::min(at.column + radius, last.column); ++x)
            largest.add(brightness(colours, grid.index(Position(x, y))));
}

bool is_firefly(const LayerToFinish &layer, std::size_t half, std::size_t i) {
    const auto samples = layer.samples.at(i);
    const float fewer = std::max(samples[1 - half] / samples[half], 1.0f); // samples here than there
    const float limit = brightness(layer.rays[half], i) / (FinishTuning::firefly_times * fewer);
    const Colours &other = layer.rays[1 - half];
    if (!(limit > brightness(other, i)) || !(limit > brightness(layer.gathered, i))) return false;
    Largest largest;
    add_around(other, layer.grid, layer.grid.position(i), FinishTuning::firefly_radius, largest);
    add_around(layer.gathered, layer.grid, layer.grid.position(i), 1, largest);
    return limit > largest.values.back();
}

} // namespace

void leave_out_fireflies(LayerToFinish &layer) {
    std::vector<char> left_out(layer.grid.size());
    parallel_ranges(left_out.size(), std::size_t(1) << 14, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            left_out[i] = is_firefly(layer, 0, i) || is_firefly(layer, 1, i);
    });
    for (std::size_t c = 0; c < layer.gathered.size(); ++c)
        for (std::size_t i = 0; i < left_out.size(); ++i)
            for (Halves *rays : {&layer.rays, &layer.averaged})
                for (Colours &half : *rays)
                    if (left_out[i] && !half.empty()) half[c][i] = layer.gathered[c][i];
}

} // namespace sparselens
