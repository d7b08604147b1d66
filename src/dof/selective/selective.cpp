#include "dof/selective/selective.h"

#include "base/error.h"
#include "base/parallel.h"
#include "dof/device/tile_device.h"
#include "dof/selective/splats.h"
#include "kernels/layer_rules.h"
#include "lens/psf.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>

namespace sparselens {

namespace {

constexpr int tile_size = splat_kernel::size;
static_assert(tile_size <= PsfRows::max_size);
constexpr std::size_t tile_pixels = std::size_t(tile_size) * tile_size;

Imath::Box2d area_of(const Imath::Box2i &tile) {
    return {Imath::V2d(tile.min), Imath::V2d(tile.max) + Imath::V2d(1, 1)};
}

// Whether discs of this radius cover the whole tile, wherever in `centres` they lie.
bool covers(double radius, const Imath::Box2d &centres, const Imath::Box2d &tile, double pixel_aspect) {
    const double dx = std::max(tile.max.x - centres.min.x, centres.max.x - tile.min.x);
    const double dy = std::max(tile.max.y - centres.min.y, centres.max.y - tile.min.y) / pixel_aspect;
    return dx * dx + dy * dy <= radius * radius;
}

// Gathers a tile: holds the sums of the bin that is being gathered, and the layers made of the bins before it.
class TileGather {
public:
    TileGather(const SplatBlocks &grid, std::size_t layers, const Imath::Box2i &data, double pixel_aspect)
        : grid_(grid), data_(data), pixel_aspect_(pixel_aspect), sums_(grid.size() * tile_pixels),
          uniform_(grid.size()), layers_(tile_pixels, layers, grid.colours) {}

    void gather(const Imath::Box2i &tile, std::span<const VisitedBlock> blocks); // front to back
    double blend(int x, int y, std::span<double> colours) const {
        return layers_.blend(pixels_.index(Imath::V2i(x, y)), colours);
    }

private:
    void finish_bin(int bin);
    void add_block(const VisitedBlock &visited);
    void add_splat(std::size_t splat);

    const SplatBlocks &grid_;
    Imath::Box2i data_;
    double pixel_aspect_;
    Imath::Box2i tile_;
    Grid pixels_;                 // of the sums: tile_size wide and high, even if the tile is smaller
    Imath::Box2i touched_;        // pixels of the tile that have sums
    std::vector<double> sums_;    // [sum][tile_size][tile_size]
    std::vector<double> uniform_; // what every pixel of the tile gets
    TileLayers layers_;
};

void TileGather::gather(const Imath::Box2i &tile, std::span<const VisitedBlock> blocks) {
    tile_ = tile;
    pixels_ = Grid({tile.min, tile.min + Imath::V2i(tile_size - 1)});
    layers_.clear();
    touched_.makeEmpty();
    for (const VisitedBlock &visited : blocks) {
        add_block(visited);
        if (visited.ends_bin) finish_bin(grid_.blocks[visited.block].bin);
    }
}

void TileGather::add_block(const VisitedBlock &visited) {
    const SplatBlock &block = grid_.blocks[visited.block];
    if (visited.covers) {
        const double *sums = &grid_.sums[visited.block * grid_.size()];
        for (std::size_t k = 0; k < uniform_.size(); ++k) uniform_[k] += sums[k];
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
            double *sum = &sums_[k * tile_pixels + pixels_.index(Imath::V2i(begin, row))];
            for (int i = 0; i < end - begin; ++i) sum[i] += weight[i] * value[k];
        }
    }
}

void TileGather::finish_bin(int bin) {
    const std::size_t size = grid_.size();
    for (int y = touched_.min.y; y <= touched_.max.y; ++y)
        for (int x = touched_.min.x; x <= touched_.max.x; ++x) {
            double *sums = &sums_[pixels_.index(Imath::V2i(x, y))];
            for (std::size_t k = 0; k < size; ++k) sums[k * tile_pixels] += uniform_[k];
            const double known = sums[tile_pixels];
            if (known > kernels::least_known) {
                const double radius = sums[(size - 1) * tile_pixels] / known;
                const double scale = 1 / window_share(data_, pixel_aspect_, x, y, radius);
                layers_.add(pixels_.index(Imath::V2i(x, y)), bin, sums, tile_pixels, scale);
            }
            for (std::size_t k = 0; k < size; ++k) sums[k * tile_pixels] = 0;
        }
    std::fill(uniform_.begin(), uniform_.end(), 0);
    touched_.makeEmpty();
}

// blend(x, y, colours) sets a pixel's colours and returns its alpha.
template <typename Blend>
void write_tile(Image &image, const SplatSource &source, const Imath::Box2i &tile, const Blend &blend) {
    std::vector<double> colours(source.colours().size());
    for (int y = tile.min.y; y <= tile.max.y; ++y)
        for (int x = tile.min.x; x <= tile.max.x; ++x) {
            const double alpha = blend(x, y, colours);
            set_pixel(image, source, x, y, alpha, colours);
        }
}

// The input of all tiles, and the picture that they make.
struct Gathering {
    const SplatSource &source;
    const SplatBlocks &grid;
    const Imath::Box2i &data;
    double pixel_aspect;
    Image &image;
    Tiles<> tiles{data, tile_size};

    std::vector<std::uint32_t> blocks_reaching_row(std::size_t row) const {
        const Imath::Box2i leftmost = tiles.box(Position(0, int(row)));
        std::vector<std::uint32_t> found;
        for (std::size_t i = 0; i < grid.blocks.size(); ++i) {
            const Imath::Box2d &reach = grid.blocks[i].reach;
            if (reach.max.y >= leftmost.min.y && reach.min.y <= leftmost.max.y + 1)
                found.push_back(std::uint32_t(i));
        }
        return found;
    }

    // The blocks of the row that reach the tile.
    std::vector<VisitedBlock> visited(const Imath::Box2i &tile, std::span<const std::uint32_t> row) const {
        const Imath::Box2d area = area_of(tile);
        std::vector<VisitedBlock> found;
        for (const std::uint32_t index : row) {
            const SplatBlock &block = grid.blocks[index];
            if (!block.reach.intersects(area)) continue;
            if (!found.empty()) found.back().ends_bin = block.bin != grid.blocks[found.back().block].bin;
            found.push_back({index, covers(block.smallest, block.centres, area, pixel_aspect), true});
        }
        return found;
    }
};

// Hands the device rows of tiles, as many at once as visit about `at_once` blocks, and marks the tiles that it
// gathered.
void gather_on(TileDevice &device, const Gathering &from, std::size_t layers, std::vector<char> &done) {
    constexpr std::size_t at_once = std::size_t{1} << 23;
    const SplatScene scene{from.grid, from.data, from.pixel_aspect, layers};
    const auto columns = std::size_t(from.tiles.columns()), rows = std::size_t(from.tiles.rows());
    std::vector<std::vector<VisitedBlock>> visited(from.tiles.count());
    for (std::size_t first = 0, end = 0; end < rows; first = end) {
        for (std::size_t count = 0; end < rows && (end == first || count < at_once); ++end) {
            const std::vector<std::uint32_t> blocks = from.blocks_reaching_row(end);
            parallel_for(columns, [&](std::size_t column) {
                const std::size_t t = end * columns + column;
                visited[t] = from.visited(from.tiles.box(t), blocks);
            });
            for (std::size_t t = end * columns; t < (end + 1) * columns; ++t) count += visited[t].size();
        }
        std::vector<SplatTask> tasks;
        for (std::size_t t = first * columns; t < end * columns; ++t)
            tasks.push_back({from.tiles.box(t), visited[t]});
        device.gather(scene, tasks, [&](std::size_t n, const SplatPicture &picture) {
            const Grid pixels({tasks[n].tile.min, tasks[n].tile.min + Imath::V2i(tile_size - 1)});
            write_tile(from.image, from.source, tasks[n].tile, [&](int x, int y, std::span<double> colours) {
                const std::size_t pixel = pixels.index(Imath::V2i(x, y));
                for (std::size_t k = 0; k < colours.size(); ++k) colours[k] = double(picture.value(pixel, k));
                return double(picture.alphas[pixel]);
            });
            done[first * columns + n] = true;
        });
        for (std::size_t t = first * columns; t < end * columns; ++t) visited[t] = {};
    }
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
    const Gathering from{source, grid, data, lens.pixel_aspect, image};
    progress.start("selective gather", from.tiles.count());
    std::vector<char> done(from.tiles.count(), false);
    if (options.device) gather_on(*options.device, from, layers, done);
    tbb::enumerable_thread_specific<TileGather> workers(
        [&] { return TileGather(grid, layers, data, lens.pixel_aspect); });
    parallel_for(std::size_t(from.tiles.rows()), [&](std::size_t row) {
        const auto columns = std::size_t(from.tiles.columns());
        const std::span<const char> done_here = std::span(done).subspan(row * columns, columns);
        if (std::ranges::all_of(done_here, [](char is) { return is; })) return progress.advance(columns);
        const std::vector<std::uint32_t> blocks = from.blocks_reaching_row(row);
        parallel_for(columns, [&](std::size_t column) {
            progress.advance();
            if (done_here[column]) return;
            const Imath::Box2i tile = from.tiles.box(Position(int(column), int(row)));
            TileGather &worker = workers.local();
            worker.gather(tile, from.visited(tile, blocks));
            write_tile(image, source, tile,
                       [&](int x, int y, std::span<double> colours) { return worker.blend(x, y, colours); });
        });
    });
    return image;
}

} // namespace sparselens
