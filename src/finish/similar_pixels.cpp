#include "finish/similar_pixels.h"

#include "base/for_processors.h"
#include "base/parallel.h"
#include "finish/regression.h"
#include "finish/tuning.h"

#include <memory>

namespace sparselens {

namespace {

constexpr int reach = FinishTuning::similar_reach;
constexpr int rows = 16, columns = 64; // of a tile
constexpr int beside = reach + 1;      // pixels loaded on each side of it
constexpr int stride = columns + 2 * beside, size = (rows + 2 * beside) * stride;
constexpr std::size_t most_channels = 3;

Colours tone_mapped_of(const Colours &guide) {
    Colours mapped = guide;
    for (Values &channel : mapped)
        for (float &v : channel) v = std::max(v, 0.0f) / (1 + std::max(v, 0.0f));
    return mapped;
}

// 1 if two patches are as alike as noise allows, falling to 0. `difference`: squared, the mean over the patch.
[[gnu::always_inline]] inline float likeness(float difference) {
    constexpr float noise = FinishTuning::similar_noise;
    const float excess = positive(difference - 2 * noise) / (2 * noise);
    const float left = positive(1 - excess / 4);
    return left * left * left; // close to exp(-excess); 0 from 4 on
}

using Plane = std::array<float, size>;
using Sums = std::array<float, std::size_t(rows *columns)>;

struct Tile {
    std::size_t channels;
    std::array<Plane, most_channels> guide;                 // beyond the picture: its border repeated
    Plane weights;                                          // beyond the picture: 0
    std::array<std::array<Plane, most_channels>, 2> rays{}; // times the weights
    Sums sum{};                                             // of likenesses, weighted
    std::array<std::array<Sums, most_channels>, 2> means{}; // means, multiplied by `sum`

    static int at(int x, int y) { return (y + beside) * stride + x + beside; }
};

using Line = std::array<float, columns + 2>; // from one pixel before the tile to one after it

// Squared differences between the pixels of a row and the pixels `apart` entries away.
[[gnu::always_inline]] inline void compare(const Tile &tile, int y, int apart, Line &line) {
    line.fill(0);
    for (std::size_t c = 0; c < tile.channels; ++c) {
        const float *here = tile.guide[c].data() + Tile::at(-1, y), *there = here + apart;
        for (std::size_t i = 0; i < line.size(); ++i) {
            const float d = here[i] - there[i];
            line[i] += d * d;
        }
    }
}

FOR_PROCESSORS void add_neighbours(Tile &tile, int dx, int dy) {
    const int apart = dy * stride + dx;
    const float share = 1 / float(9 * tile.channels);
    std::array<Line, 3> lines;
    compare(tile, -1, apart, lines[0]);
    compare(tile, 0, apart, lines[1]);
    for (int y = 0; y < rows; ++y) {
        compare(tile, y + 1, apart, lines[std::size_t(y + 2) % 3]);
        Line together;
        for (std::size_t i = 0; i < together.size(); ++i)
            together[i] = lines[0][i] + lines[1][i] + lines[2][i];
        std::array<float, columns> alike;
        for (std::size_t i = 0; i < columns; ++i)
            alike[i] = likeness((together[i] + together[i + 1] + together[i + 2]) * share);
        const auto there = std::size_t(Tile::at(0, y) + apart), here = std::size_t(y * columns);
        for (std::size_t i = 0; i < columns; ++i) tile.sum[here + i] += alike[i] * tile.weights[there + i];
        for (std::size_t k = 0; k < 2; ++k)
            for (std::size_t c = 0; c < tile.channels; ++c) {
                float *mean = tile.means[k][c].data() + here;
                const float *rays = tile.rays[k][c].data() + there;
                for (std::size_t i = 0; i < columns; ++i) mean[i] += alike[i] * rays[i];
            }
    }
}

struct Pixels {
    const Halves &rays;
    const Colours &guide; // tone-mapped
    const Values &weights;
    const Grid &grid;
};

void load(const Pixels &pixels, const Imath::Box2i &box, Tile &tile) {
    const Grid &grid = pixels.grid;
    tile.channels = pixels.guide.size();
    std::array<std::size_t, stride> column;
    std::array<float, stride> inside;
    for (int i = 0; i < stride; ++i) {
        const int x = box.min.x - beside + i, nearest = std::clamp(x, 0, grid.width() - 1);
        column[std::size_t(i)] = std::size_t(nearest);
        inside[std::size_t(i)] = x == nearest ? 1 : 0;
    }
    for (int y = -beside; y < rows + beside; ++y) {
        const int nearest = std::clamp(box.min.y + y, 0, grid.height() - 1);
        const float within = nearest == box.min.y + y ? 1 : 0;
        const std::size_t from = grid.index(0, nearest);
        const auto to = std::size_t(Tile::at(-beside, y));
        for (std::size_t i = 0; i < stride; ++i)
            tile.weights[to + i] = within * inside[i] * pixels.weights[from + column[i]];
        for (std::size_t c = 0; c < tile.channels; ++c) {
            for (std::size_t i = 0; i < stride; ++i)
                tile.guide[c][to + i] = pixels.guide[c][from + column[i]];
            for (std::size_t k = 0; k < 2; ++k)
                for (std::size_t i = 0; i < stride; ++i)
                    tile.rays[k][c][to + i] = tile.weights[to + i] * pixels.rays[k][c][from + column[i]];
        }
    }
}

void store(const Tile &tile, const Imath::Box2i &box, const Grid &grid, Halves &means) {
    for (int y = box.min.y; y <= box.max.y; ++y)
        for (int x = box.min.x; x <= box.max.x; ++x) {
            const auto from = std::size_t((y - box.min.y) * columns + x - box.min.x);
            for (std::size_t k = 0; k < 2; ++k)
                for (std::size_t c = 0; c < tile.channels; ++c)
                    means[k][c][grid.index(x, y)] = tile.means[k][c][from] / tile.sum[from];
        }
}

} // namespace

Halves means_of_similar(const Halves &rays, const Colours &guide, const Grid &grid) {
    const Colours mapped = tone_mapped_of(guide);
    const Values weights = tone_weights(guide);
    const Colours unset(guide.size(), Values(grid.size()));
    Halves means{unset, unset};
    const Tiles tiles(grid.box(), columns, rows);
    parallel_for(tiles.count(), [&](std::size_t t) {
        const Imath::Box2i box = tiles.box(t);
        const auto tile = std::make_unique<Tile>();
        load({rays, mapped, weights, grid}, box, *tile);
        for (int dy = -reach; dy <= reach; ++dy)
            for (int dx = -reach; dx <= reach; ++dx) add_neighbours(*tile, dx, dy);
        store(*tile, box, grid, means);
    });
    return means;
}

} // namespace sparselens
