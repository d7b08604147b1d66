#include "dof/selective/selective.h"

#include "base/error.h"
#include "base/parallel.h"
#include "dof/selective/blend.h"
#include "dof/selective/splat_blocks.h"
#include "lens/psf.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>

namespace sparselens {

namespace {

constexpr int tile_size = 32; // pixels
static_assert(tile_size <= PsfRows::max_size);
constexpr std::size_t tile_pixels = std::size_t(tile_size) * tile_size;

Imath::Box2d area_of(const Imath::Box2i &tile) {
    return {Imath::V2d(tile.min), Imath::V2d(tile.max) + Imath::V2d(1, 1)};
}

// Do discs of that radius cover the whole tile, wherever in `centres` they stand?
bool covers(double radius, const Imath::Box2d &centres, const Imath::Box2d &tile, double pixel_aspect) {
    const double dx = std::max(tile.max.x - centres.min.x, centres.max.x - tile.min.x);
    const double dy = std::max(tile.max.y - centres.min.y, centres.max.y - tile.min.y) / pixel_aspect;
    return dx * dx + dy * dy <= radius * radius;
}

// One tile at work: the sums of the bin that is being gathered, and the layers made of the bins before it.
class TileGather {
public:
    TileGather(const SplatBlocks &grid, std::size_t layers, const Imath::Box2i &data, double pixel_aspect)
        : grid_(grid), data_(data), pixel_aspect_(pixel_aspect), sums_(grid.size() * tile_pixels),
          uniform_(grid.size()), layers_(tile_pixels, layers, grid.colours) {}

    // `blocks` are the indices of those that may reach the tile, front to back.
    void gather(const Imath::Box2i &tile, std::span<const std::size_t> blocks);
    double blend(int x, int y, std::span<double> colours) const {
        return layers_.blend(pixels_.index(x, y), colours);
    }

private:
    void finish_bin();
    void add_block(std::size_t index);
    void add_splat(std::size_t splat);

    const SplatBlocks &grid_;
    Imath::Box2i data_;
    double pixel_aspect_;
    Imath::Box2i tile_;
    Grid pixels_; // of the sums: tile_size wide and high, also where the tile is smaller
    int bin_ = 0;
    Imath::Box2i touched_;        // pixels of the tile that have sums
    std::vector<double> sums_;    // [sum][tile_size][tile_size]
    std::vector<double> uniform_; // what all pixels of the tile get alike
    TileLayers layers_;
};

void TileGather::gather(const Imath::Box2i &tile, std::span<const std::size_t> blocks) {
    tile_ = tile;
    pixels_ = Grid({tile.min, tile.min + Imath::V2i(tile_size - 1)});
    layers_.clear();
    touched_.makeEmpty();
    const Imath::Box2d area = area_of(tile);
    bool first = true;
    for (const std::size_t index : blocks) {
        const SplatBlock &block = grid_.blocks[index];
        if (!block.reach.intersects(area)) continue;
        if (!first && block.bin != bin_) finish_bin();
        first = false;
        bin_ = block.bin;
        add_block(index);
    }
    finish_bin();
}

void TileGather::add_block(std::size_t index) {
    const SplatBlock &block = grid_.blocks[index];
    if (covers(block.smallest, block.centres, area_of(tile_), pixel_aspect_)) {
        for (std::size_t k = 0; k < uniform_.size(); ++k) uniform_[k] += grid_.sums[index * grid_.size() + k];
        touched_.extendBy(tile_);
        return;
    }
    for (std::size_t i = block.begin; i < block.end; ++i) add_splat(i);
}

void TileGather::add_splat(std::size_t splat) {
    const double x = grid_.x[splat], y = grid_.y[splat], radius = grid_.radius[splat];
    if (x + radius < tile_.min.x || x - radius > tile_.max.x + 1) return;
    const PsfRows rows({{x, y}, radius, pixel_aspect_}, tile_);
    const std::span<const float> value = grid_.value(splat);
    std::array<double, tile_size> weights;
    for (int row = rows.begin_row(); row < rows.end_row(); ++row) {
        const auto [begin, end] = rows.row(row, weights.data());
        if (begin >= end) continue;
        touched_.extendBy(Imath::Box2i({begin, row}, {end - 1, row}));
        const double *weight = weights.data() + (begin - tile_.min.x);
        for (std::size_t k = 0; k < value.size(); ++k) {
            double *sum = &sums_[k * tile_pixels + pixels_.index(begin, row)];
            for (int i = 0; i < end - begin; ++i) sum[i] += weight[i] * value[k];
        }
    }
}

void TileGather::finish_bin() {
    const std::size_t size = grid_.size();
    for (int y = touched_.min.y; y <= touched_.max.y; ++y)
        for (int x = touched_.min.x; x <= touched_.max.x; ++x) {
            double *sums = &sums_[pixels_.index(x, y)];
            for (std::size_t k = 0; k < size; ++k) sums[k * tile_pixels] += uniform_[k];
            const double known = sums[tile_pixels];
            if (known > least_known) {
                const double radius = sums[(size - 1) * tile_pixels] / known;
                const double scale = 1 / window_share(data_, pixel_aspect_, x, y, radius);
                layers_.add(pixels_.index(x, y), bin_, sums, tile_pixels, scale);
            }
            for (std::size_t k = 0; k < size; ++k) sums[k * tile_pixels] = 0;
        }
    std::fill(uniform_.begin(), uniform_.end(), 0);
    touched_.makeEmpty();
}

void write_tile(Image &image, const SplatSource &source, const Imath::Box2i &tile, const TileGather &gather) {
    std::vector<double> colours(source.colours().size());
    for (int y = tile.min.y; y <= tile.max.y; ++y)
        for (int x = tile.min.x; x <= tile.max.x; ++x) {
            const double alpha = gather.blend(x, y, colours);
            set_pixel(image, source, x, y, alpha, colours);
        }
}

std::vector<std::size_t> blocks_reaching_rows(const SplatBlocks &grid, int first, int last) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < grid.blocks.size(); ++i)
        if (grid.blocks[i].reach.max.y >= first && grid.blocks[i].reach.min.y <= last + 1) found.push_back(i);
    return found;
}

} // namespace

Image selective_gather(const Ldi &ldi, const ThinLens &lens, const SelectiveOptions &options,
                       Progress &progress) {
    if (options.layers < 1) throw UsageError("the number of layers must be at least 1");
    const SplatSource source(ldi, lens);
    const SplatBlocks grid = make_splat_blocks(source);
    Image image = image_with_ids(ldi);
    const Imath::Box2i &data = ldi.windows.data;
    // No pixel has more layers than there are bins, and memory is set aside for as many as it may have.
    const std::size_t layers = std::clamp(grid.bins, std::size_t(1), std::size_t(options.layers));
    const Tiles tiles(data, tile_size);
    tbb::enumerable_thread_specific<TileGather> workers(
        [&] { return TileGather(grid, layers, data, lens.pixel_aspect); });
    progress.start("selective gather", tiles.count());
    parallel_for(std::size_t(tiles.rows()), [&](std::size_t row) {
        const Imath::Box2i leftmost = tiles.box(0, int(row));
        const std::vector<std::size_t> blocks = blocks_reaching_rows(grid, leftmost.min.y, leftmost.max.y);
        parallel_for(std::size_t(tiles.columns()), [&](std::size_t column) {
            const Imath::Box2i tile = tiles.box(int(column), int(row));
            TileGather &worker = workers.local();
            worker.gather(tile, blocks);
            write_tile(image, source, tile, worker);
            progress.advance();
        });
    });
    return image;
}

} // namespace sparselens
