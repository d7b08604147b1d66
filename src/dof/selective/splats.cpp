#include "dof/selective/splats.h"

#include "base/parallel.h"
#include "dof/tuning.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace sparselens {

SplatSource::SplatSource(const Ldi &ldi, const ThinLens &lens)
    : ldi_(ldi), grid_(ldi.windows.grid()), lens_(lens), alpha_(ldi.alpha()) {
    if (alpha() != npos) alphas_ = ldi.values[alpha()].data();
    for (std::size_t i = 0; i < ldi.channels.size(); ++i)
        if (i != alpha() && !holds_ids(ldi.channels[i])) colours_.push_back(i);
}

Imath::V2d SplatSource::position(std::size_t pixel, std::size_t sample) const {
    const Imath::V2i corner = grid_.pixel(pixel);
    // An offset of exactly 1/2 would put a sharp sample into the next pixel.
    constexpr double limit = 0.5 - 0x1p-20;
    const auto offset = [&](const std::vector<float> &offsets) {
        return offsets.empty() || sample == npos ? 0.0 : std::clamp(double(offsets[sample]), -limit, limit);
    };
    return {corner.x + 0.5 + offset(ldi_.dx), corner.y + 0.5 + offset(ldi_.dy)};
}

Splat SplatSource::background(std::size_t pixel, double passed) const {
    const double coc = circle_of_confusion(lens_, std::numeric_limits<double>::infinity());
    return {position(pixel, npos), coc, depth_bin(coc), 0, passed, 0, npos};
}

Image image_with_ids(const Ldi &ldi) {
    Image image(ldi.windows, ldi.channels);
    for (std::size_t channel = 0; channel < ldi.channels.size(); ++channel) {
        if (!holds_ids(ldi.channels[channel])) continue;
        const std::span<float> plane = image.plane(channel);
        for (std::size_t pixel = 0; pixel < plane.size(); ++pixel)
            if (!ldi.pixel(pixel).empty()) plane[pixel] = ldi.values[channel][ldi.pixel(pixel).front()];
    }
    return image;
}

void set_pixel(Image &image, const SplatSource &source, int x, int y, double alpha,
               std::span<const double> colours) {
    for (std::size_t k = 0; k < colours.size(); ++k) image.at(source.colours()[k], x, y) = float(colours[k]);
    if (source.alpha() != npos) image.at(source.alpha(), x, y) = float(alpha);
}

namespace {

constexpr int square_size = 16; // pixels

// Calls visit(splat) for the splats of the pixels of a square.
template <typename Visit>
void for_each_splat(const SplatSource &source, const Imath::Box2i &square, const Visit &visit) {
    for (int y = square.min.y; y <= square.max.y; ++y)
        for (int x = square.min.x; x <= square.max.x; ++x)
            source.for_each(source.ldi().windows.index(Imath::V2i(x, y)), visit);
}

// The splats of a square front to back; equal bins stay in pixel order.
std::vector<Splat> splats_of_square(const SplatSource &source, const Imath::Box2i &square) {
    std::vector<Splat> splats;
    for_each_splat(source, square, [&](const Splat &splat) { splats.push_back(splat); });
    std::stable_sort(splats.begin(), splats.end(),
                     [](const auto &a, const auto &b) { return a.bin < b.bin; });
    return splats;
}

void put_values(SplatBlocks &grid, std::size_t at, const Splat &splat, const SplatSource &source) {
    float *value = &grid.values[at * grid.size()];
    *value++ = float(splat.coverage);
    *value++ = float(splat.known);
    for (const std::size_t channel : source.colours()) *value++ = float(source.colour(splat, channel));
    *value = float(splat.known * std::abs(splat.coc));
}

void extend(SplatBlock &block, const Splat &splat, double pixel_aspect) {
    const double radius = std::abs(splat.coc);
    const Imath::V2d extent(radius, radius * pixel_aspect);
    block.centres.extendBy(splat.position);
    block.reach.extendBy(splat.position - extent);
    block.reach.extendBy(splat.position + extent);
    block.smallest = block.begin == block.end ? radius : std::min(block.smallest, radius);
    ++block.end;
}

// Stores a square's splats from `first` on and returns its blocks.
std::vector<SplatBlock> store_square(SplatBlocks &grid, std::size_t first, std::span<const Splat> splats,
                                     const SplatSource &source) {
    std::vector<SplatBlock> blocks;
    for (std::size_t i = 0; i < splats.size(); ++i) {
        const Splat &splat = splats[i];
        const std::size_t at = first + i;
        if (blocks.empty() || blocks.back().bin != splat.bin)
            blocks.push_back({splat.bin, at, at, {}, {}, 0});
        extend(blocks.back(), splat, source.lens().pixel_aspect);
        grid.x[at] = splat.position.x;
        grid.y[at] = splat.position.y;
        grid.radius[at] = std::abs(splat.coc);
        put_values(grid, at, splat, source);
    }
    return blocks;
}

// The sums are double, because they may add up any number of splats.
void sum_blocks(SplatBlocks &grid, double pixel_aspect) {
    grid.sums.assign(grid.blocks.size() * grid.size(), 0);
    parallel_for(grid.blocks.size(), [&](std::size_t index) {
        const SplatBlock &block = grid.blocks[index];
        if (block.smallest < 0.5) return; // cannot cover a tile, not even of one pixel
        for (std::size_t i = block.begin; i < block.end; ++i) {
            const double weight = 1 / (std::numbers::pi * grid.radius[i] * grid.radius[i] * pixel_aspect);
            for (std::size_t k = 0; k < grid.size(); ++k)
                grid.sums[index * grid.size() + k] += weight * grid.value(i)[k];
        }
    });
}

} // namespace

SplatBlocks make_splat_blocks(const SplatSource &source) {
    const Tiles squares(source.ldi().windows.data, square_size);
    std::vector<std::size_t> first(squares.count() + 1, 0);
    parallel_for(squares.count(), [&](std::size_t square) {
        for_each_splat(source, squares.box(square), [&](const Splat &) { ++first[square + 1]; });
    });
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];

    SplatBlocks grid;
    grid.colours = source.colours().size();
    for (auto *array : {&grid.x, &grid.y, &grid.radius}) array->resize(first.back());
    grid.values.resize(first.back() * grid.size());
    grid.blocks = joined(squares.count(), [&](std::size_t square) {
        return store_square(grid, first[square], splats_of_square(source, squares.box(square)), source);
    });
    std::stable_sort(grid.blocks.begin(), grid.blocks.end(),
                     [](const SplatBlock &a, const SplatBlock &b) { return a.bin < b.bin; });
    for (std::size_t i = 0; i < grid.blocks.size(); ++i)
        grid.bins += i == 0 || grid.blocks[i].bin != grid.blocks[i - 1].bin;
    sum_blocks(grid, source.lens().pixel_aspect);
    return grid;
}

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
