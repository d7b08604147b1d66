#include "finish/finish.h"

#include "base/parallel.h"
#include "finish/cross_validation.h"
#include "finish/tuning.h"
#include "finish/window_means.h"

#include <memory>
#include <numeric>

namespace sparselens {

namespace {

Halves regressed(const LayerToFinish &layer, const Halves &rays, const Values &weights,
                 const FinishTuning::Window &window) {
    Halves predicted;
    for (std::size_t c = 0; c < layer.gathered.size(); ++c) {
        const Regression on_guide(layer.gathered[c], weights, layer.grid, window);
        for (std::size_t k = 0; k < 2; ++k) predicted[k].push_back(on_guide.of(rays[k][c]));
    }
    return predicted;
}

// Keeps pixels on which picture and renders agree, such as coverage of 1. Few rays may miss a small lamp in a pixel, so
// the pixels around it must agree, too. Nothing around an object stays nothing, however far windows reach.
void keep_agreed(const LayerToFinish &layer, FinishedLayer &finished) {
    Values agreed(layer.grid.size(), 1.0f);
    for (std::size_t i = 0; i < agreed.size(); ++i)
        for (std::size_t c = 0; c < layer.gathered.size(); ++c)
            if (layer.rays[0][c][i] != layer.gathered[c][i] || layer.rays[1][c][i] != layer.gathered[c][i])
                agreed[i] = 0;
    box_mean(agreed, layer.grid, FinishTuning::agreed_radius);
    for (std::size_t i = 0; i < layer.grid.size(); ++i) {
        if (agreed[i] < 1 && (layer.nothing.empty() || !layer.nothing[i])) continue;
        for (Colours *colours : {&finished.picture, &finished.of_one[0], &finished.of_one[1]})
            for (std::size_t c = 0; c < colours->size(); ++c) (*colours)[c][i] = layer.gathered[c][i];
        finished.kept[i] = 1;
    }
}

} // namespace

FinishedLayer finish_layer(const LayerToFinish &layer, Progress &progress) {
    const float exposure = exposure_of(layer.gathered);
    const RayEvidence evidence{layer.rays, layer.samples, layer.grid, exposure};
    FinishedLayer finished;
    finished.kept.assign(layer.grid.size(), 1.0f);
    Trio pictures{layer.gathered, layer.gathered, layer.gathered};
    const auto offer = [&](const Halves &candidate) {
        blend_in(pictures, candidate, evidence, finished.kept);
        progress.advance();
    };
    progress.start("finish", 2 * layer.given.size() + FinishTuning::regression_windows.size() + 3);
    for (const Halves &given : layer.given) offer(given);
    const Halves &rays = layer.averaged[0].empty() ? layer.rays : layer.averaged;
    const Values weights = tone_weights(layer.gathered, exposure);
    for (const FinishTuning::Window &window : FinishTuning::regression_windows)
        offer(regressed(layer, rays, weights, window));
    offer(rays);
    offer(means_of_similar(rays, pictures[2], layer.grid, exposure));
    // Once more, where the others made it worse.
    offer(rays);
    for (const Halves &given : layer.given) offer(given);
    finished.picture = std::move(pictures[2]);
    finished.of_one = {std::move(pictures[0]), std::move(pictures[1])};
    keep_agreed(layer, finished);
    return finished;
}

namespace {

// Keeps the prior above 0 where the whole guide is black.
constexpr float least_square = 1e-30f;

// The mean of `of(i)` over soft windows around cells.
template <typename Of>
Values averaged(const Cells &cells, int radius, const Of &of) {
    Values means(cells.grid().size(), 0.0f);
    const auto width = std::size_t(cells.pixels().width());
    parallel_for(std::size_t(cells.grid().height()), [&](std::size_t row) {
        const std::span<float> sums = cells.of_row(means, row);
        const auto [begin, end] = cells.rows(row);
        for (std::size_t y = begin; y < end; ++y)
            for (std::size_t x = 0; x < width; x += run_length) {
                Run run{};
                const std::size_t first = y * width + x, count = std::min(run_length, width - x);
                for (std::size_t i = 0; i < count; ++i) run[i] = of(first + i);
                cells.add(run, x, sums);
            }
        cells.divide(row, sums);
    });
    soft_mean(means, cells.grid(), radius);
    return means;
}

} // namespace

Values tone_weights(const Colours &guide, float exposure) {
    Values weights(guide.front().size());
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const float reciprocal = 1 / (1 + exposure * brightness(guide, i));
        weights[i] = reciprocal * reciprocal;
    }
    return weights;
}

Regression::Regression(std::span<const float> guide, std::span<const float> weights, const ArrayGrid &grid,
                       const FinishTuning::Window &window)
    : guide_(guide), weights_(weights), cells_(grid, window.cell), radius_(window.radius) {
    weight_ = averaged(cells_, radius_, [&](std::size_t i) { return weights[i]; });
    mean_ = averaged(cells_, radius_, [&](std::size_t i) { return weights[i] * guide[i]; });
    variance_ = averaged(cells_, radius_, [&](std::size_t i) { return weights[i] * guide[i] * guide[i]; });
    square_ = float(std::accumulate(variance_.begin(), variance_.end(), 0.0) /
                    std::accumulate(weight_.begin(), weight_.end(), 0.0));
    for (std::size_t i = 0; i < mean_.size(); ++i) {
        mean_[i] /= weight_[i];
        variance_[i] = std::max(variance_[i] / weight_[i] - mean_[i] * mean_[i], 0.0f);
    }
}

Values Regression::of(std::span<const float> rays) const {
    // The lines: slope * guide + level.
    Values level = averaged(cells_, radius_, [&](std::size_t i) { return weights_[i] * rays[i]; });
    Values slope =
        averaged(cells_, radius_, [&](std::size_t i) { return weights_[i] * guide_[i] * rays[i]; });
    double covariances = 0, variances = 0;
    for (std::size_t i = 0; i < level.size(); ++i) {
        covariances += double(slope[i] - mean_[i] * level[i]);
        variances += double(weight_[i] * variance_[i]);
    }
    const auto of_all = variances > 0 ? float(covariances / variances) : 0.0f;
    for (std::size_t i = 0; i < level.size(); ++i) {
        const float y = level[i] / weight_[i], covariance = slope[i] / weight_[i] - mean_[i] * y;
        const float prior = FinishTuning::regression_prior *
                            (FinishTuning::regression_floor * square_ + mean_[i] * mean_[i] + least_square);
        slope[i] = (covariance + prior * of_all) / (variance_[i] + prior);
        level[i] = y - slope[i] * mean_[i];
    }
    Values found(guide_.size());
    const auto width = std::size_t(cells_.pixels().width());
    parallel_for(std::size_t(cells_.pixels().height()), [&](std::size_t y) {
        std::vector<float> slopes, levels;
        cells_.interpolate(slope, y, slopes);
        cells_.interpolate(level, y, levels);
        for (std::size_t x = 0; x < width; ++x)
            found[y * width + x] = levels[x] + slopes[x] * guide_[y * width + x];
    });
    return found;
}

namespace {

constexpr int reach = FinishTuning::similar_reach;
constexpr int rows = 16, columns = 64; // of a tile
constexpr int beside = reach + 1;      // pixels loaded on each side of it
constexpr int stride = columns + 2 * beside, size = (rows + 2 * beside) * stride;
constexpr std::size_t most_channels = 3;

Colours tone_mapped_of(const Colours &guide, float exposure) {
    Colours mapped = guide;
    for (Values &channel : mapped)
        for (float &v : channel) v = positive(exposure * v) / (1 + positive(exposure * v));
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
    const ArrayGrid &grid;
};

void load(const Pixels &pixels, const PositionBox &box, Tile &tile) {
    const ArrayGrid &grid = pixels.grid;
    tile.channels = pixels.guide.size();
    std::array<std::size_t, stride> column;
    std::array<float, stride> inside;
    for (int i = 0; i < stride; ++i) {
        const int x = box.min.column - beside + i, nearest = std::clamp(x, 0, grid.width() - 1);
        column[std::size_t(i)] = std::size_t(nearest);
        inside[std::size_t(i)] = x == nearest ? 1 : 0;
    }
    for (int y = -beside; y < rows + beside; ++y) {
        const int nearest = std::clamp(box.min.row + y, 0, grid.height() - 1);
        const float within = nearest == box.min.row + y ? 1 : 0;
        const std::size_t from = grid.index(Position(0, nearest));
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

void store(const Tile &tile, const PositionBox &box, const ArrayGrid &grid, Halves &means) {
    for (int y = box.min.row; y <= box.max.row; ++y)
        for (int x = box.min.column; x <= box.max.column; ++x) {
            const auto from = std::size_t((y - box.min.row) * columns + x - box.min.column);
            for (std::size_t k = 0; k < 2; ++k)
                for (std::size_t c = 0; c < tile.channels; ++c)
                    means[k][c][grid.index(Position(x, y))] = tile.means[k][c][from] / tile.sum[from];
        }
}

} // namespace

Halves means_of_similar(const Halves &rays, const Colours &guide, const ArrayGrid &grid, float exposure) {
    const Colours mapped = tone_mapped_of(guide, exposure);
    const Values weights = tone_weights(guide, exposure);
    const Colours unset(guide.size(), Values(grid.size()));
    Halves means{unset, unset};
    const Tiles tiles(grid.box(), columns, rows);
    parallel_for(tiles.count(), [&](std::size_t t) {
        const PositionBox box = tiles.box(t);
        const auto tile = std::make_unique<Tile>();
        load({rays, mapped, weights, grid}, box, *tile);
        for (int dy = -reach; dy <= reach; ++dy)
            for (int dx = -reach; dx <= reach; ++dx) add_neighbours(*tile, dx, dy);
        store(*tile, box, grid, means);
    });
    return means;
}

} // namespace sparselens
