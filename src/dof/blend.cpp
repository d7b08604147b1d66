#include "dof/blend.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace sparselens {

namespace {
double env(const char *n, double d) {
    const char *s = std::getenv(n);
    return s ? std::atof(s) : d;
}
const double bin_width = env("BINW", 0.5); // pixels of CoC
const double linear_to = env("BINL", 64) * bin_width;
const int mode = int(env("MODE", 0));
} // namespace

int depth_bin(double coc) {
    const double size = std::abs(coc);
    const double bent = size < linear_to ? size : linear_to * (1 + std::log(size / linear_to));
    return int(std::floor(std::copysign(bent / bin_width, coc)));
}

double blend_layers(std::span<const double> layers, double background, std::span<double> colours) {
    std::fill(colours.begin(), colours.end(), 0);
    double left = 1, covered = 0;
    const std::size_t size = 1 + colours.size();
    for (std::size_t i = 0; i < layers.size(); i += size) {
        double coverage = std::min(layers[i], 1.0);
        if (mode == 1 && background == 0 && i + size == layers.size()) coverage = 1;
        const double share = mode == 2 ? std::min(left, coverage) : left * coverage;
        for (std::size_t k = 0; k < colours.size(); ++k)
            colours[k] += share * (layers[i + 1 + k] / layers[i]);
        covered += share;
        left -= share;
    }
    const double known = covered + std::min(left, background);
    if (known <= 0) return 0;
    for (double &colour : colours) colour /= known;
    return covered / known;
}

TileLayers::TileLayers(std::size_t pixels, std::size_t limit, std::size_t colours)
    : limit_(limit), size_(1 + colours), states_(pixels), gaps_(pixels * (limit + 1)),
      sums_(pixels * (limit + 1) * size_) {}

void TileLayers::clear() { std::fill(states_.begin(), states_.end(), State{}); }

void TileLayers::add(std::size_t pixel, int bin, const double *sums, std::size_t stride) {
    State &state = states_[pixel];
    if (bin == background_bin) {
        state.background += *sums;
        return;
    }
    if (state.count > 0 && bin <= state.last_bin + 1) {
        double *current = layer(pixel, state.count - 1);
        for (std::size_t k = 0; k < size_; ++k) current[k] += sums[k * stride];
    } else {
        double *fresh = layer(pixel, state.count);
        for (std::size_t k = 0; k < size_; ++k) fresh[k] = sums[k * stride];
        gap(pixel, state.count) = bin - state.last_bin;
        if (++state.count > limit_) merge_closest(pixel);
    }
    state.last_bin = bin;
}

// A merge leaves the other gaps as they are, so merging as layers come keeps the same widest gaps as merging
// when all are there.
void TileLayers::merge_closest(std::size_t pixel) {
    std::size_t closest = 1;
    State &state = states_[pixel];
    for (std::size_t i = 2; i < state.count; ++i)
        if (gap(pixel, i) < gap(pixel, closest)) closest = i;
    double *front = layer(pixel, closest - 1);
    for (std::size_t k = 0; k < size_; ++k) front[k] += front[size_ + k];
    std::copy(front + 2 * size_, front + state.count * size_ - (closest - 1) * size_, front + size_);
    std::copy(&gap(pixel, closest) + 1, &gap(pixel, 0) + state.count, &gap(pixel, closest));
    --state.count;
}

double TileLayers::blend(std::size_t pixel, std::span<double> colours) const {
    const State &state = states_[pixel];
    const std::span<const double> layers(&sums_[pixel * (limit_ + 1) * size_], state.count * size_);
    return blend_layers(layers, state.background, colours);
}

} // namespace sparselens
