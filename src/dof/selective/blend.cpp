#include "dof/selective/blend.h"

#include "dof/tuning.h"
#include "kernels/layer_rules.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

int depth_bin(double coc) {
    const double size = std::abs(coc);
    constexpr double linear_to = GatherTuning::bins_linear_to_px;
    const double bent = size < linear_to ? size : linear_to * (1 + std::log(size / linear_to));
    return int(std::floor(std::copysign(bent / GatherTuning::bin_px, coc)));
}

double window_share(const Imath::Box2i &data, double pixel_aspect, int x, int y, double radius) {
    return kernels::window_share(data.min.x, data.min.y, data.max.x, data.max.y, pixel_aspect, x, y, radius);
}

// Goes from back to front, so that at each layer `known` is the sum over this layer and the layers behind it.
double blend_layers(std::span<const double> layers, std::span<double> colours) {
    std::fill(colours.begin(), colours.end(), 0);
    double alpha = 0, known = 0;
    const std::size_t size = sums_before_colours + colours.size();
    for (std::size_t i = layers.size(); i > 0; i -= size) {
        const std::span<const double> layer = layers.subspan(i - size, size);
        const double coverage = layer[0];
        known += layer[1];
        if (coverage <= 0) continue;
        const double share = kernels::layer_share(coverage, known);
        for (std::size_t k = 0; k < colours.size(); ++k)
            colours[k] = kernels::over(share, layer[sums_before_colours + k] / coverage, colours[k]);
        alpha = kernels::over(share, 1, alpha);
    }
    return alpha;
}

TileLayers::TileLayers(std::size_t pixels, std::size_t limit, std::size_t colours)
    : limit_(limit), size_(sums_before_colours + colours), states_(pixels), gaps_(pixels * (limit + 1)),
      sums_(pixels * (limit + 1) * size_) {}

void TileLayers::clear() { std::fill(states_.begin(), states_.end(), State{}); }

void TileLayers::add(std::size_t pixel, int bin, const double *sums, std::size_t stride, double scale) {
    State &state = states_[pixel];
    if (state.count > 0 && kernels::joins_layer(bin, state.last_bin)) {
        double *current = layer(pixel, state.count - 1);
        for (std::size_t k = 0; k < size_; ++k) current[k] += scale * sums[k * stride];
    } else {
        double *fresh = layer(pixel, state.count);
        for (std::size_t k = 0; k < size_; ++k) fresh[k] = scale * sums[k * stride];
        gap(pixel, state.count) = bin - state.last_bin;
        if (++state.count > limit_) merge_closest(pixel);
    }
    state.last_bin = bin;
}

// A merge leaves the other gaps as they are, so merging while layers come keeps the same widest gaps as merging at the
// end.
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
    return blend_layers(layers, colours);
}

} // namespace sparselens
