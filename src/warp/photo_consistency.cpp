#include "warp/photo_consistency.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sparselens {

namespace {

constexpr int block_size = 8;             // pixels
constexpr double least_ratio = 3;         // noise alone gives up to 1.6, edges of texture up to 2
constexpr double least_difference = 1e-5; // mean square, tone-mapped: less is not seen
constexpr double focus_px = 2;            // CoC up to which a surface counts as in focus

// What a block of pixels has shown so far.
struct Block {
    double difference = 0, variation = 0; // sums of squares over channels
    double coc = 0;                       // sum of |CoC|
    double pixels = 0;

    bool agrees() const {
        return difference <= least_ratio * variation + least_difference * pixels || coc <= focus_px * pixels;
    }
};

// Bounded, so that one bright pixel does not decide for its block.
double tone_mapped(float v) { return double(v) / (1 + std::abs(double(v))); }

class CentreColours {
public:
    explicit CentreColours(const Ldi &centre) : centre_(centre), grid_(centre.windows.grid()) {
        for (const std::size_t channel : find_rgb(centre.channels))
            if (channel != npos) channels_.push_back(channel);
    }
    std::span<const std::size_t> channels() const { return channels_; }

    // Whether the pixel and the four around it show one sample each: their variation is that of one picture.
    bool plain(int x, int y) const {
        const Imath::Box2i &data = centre_.windows.data;
        if (x <= data.min.x || x >= data.max.x || y <= data.min.y || y >= data.max.y) return false;
        return single(grid_.index(x, y)) &&
               std::ranges::all_of(around(x, y), [&](std::size_t i) { return single(i); });
    }
    double value(int x, int y, std::size_t channel) const { return value_at(grid_.index(x, y), channel); }
    double mean_around(int x, int y, std::size_t channel) const {
        double sum = 0;
        for (const std::size_t i : around(x, y)) sum += value_at(i, channel);
        return sum / 4;
    }

private:
    std::array<std::size_t, 4> around(int x, int y) const {
        return {grid_.index(x - 1, y), grid_.index(x + 1, y), grid_.index(x, y - 1), grid_.index(x, y + 1)};
    }
    bool single(std::size_t i) const { return centre_.pixel(i).size() == 1; }
    double value_at(std::size_t i, std::size_t channel) const {
        return tone_mapped(centre_.values[channel][centre_.pixel(i).front()]);
    }

    const Ldi &centre_;
    Grid grid_;
    std::vector<std::size_t> channels_;
};

double rim_mean(const ReprojectedViews &views, const Surface &surface, std::size_t channel) {
    double sum = 0, total = 0;
    for (const ViewSample &s : surface.samples) {
        if (s.view == 0) continue;
        sum += s.weight * tone_mapped(views.value(s, channel));
        total += s.weight;
    }
    return sum / total;
}

void compare(const ReprojectedViews &views, const CentreColours &centre,
             const PhotoConsistencyOptions &options, const Surface &surface, Block &block) {
    const int x = surface.samples[0].x, y = surface.samples[0].y;
    for (const std::size_t channel : centre.channels()) {
        const double own = centre.value(x, y, channel);
        const double difference = rim_mean(views, surface, channel) - own;
        const double variation = centre.mean_around(x, y, channel) - own;
        block.difference += difference * difference;
        block.variation += variation * variation;
    }
    constexpr double out_of_focus = 2 * focus_px;
    block.coc +=
        options.lens ? std::abs(circle_of_confusion(*options.lens, 1 / surface.inverse_z)) : out_of_focus;
    block.pixels += 1;
}

} // namespace

std::vector<bool> find_photo_consistency(const ReprojectedViews &views,
                                         const PhotoConsistencyOptions &options, const Imath::Box2i &data,
                                         const Surfaces &surfaces) {
    const int width = Grid(data).width();
    const Grid grid(width, int(surfaces.pixels() / std::size_t(width)));
    const Tiles tiles(grid.box(), block_size);
    const auto block_of = [&](std::size_t pixel) { return tiles.tile_of(grid.pixel(pixel)); };
    const CentreColours centre(views.samples(0));
    std::vector<Block> blocks(tiles.count());
    for (std::size_t pixel = 0; pixel < surfaces.pixels(); ++pixel)
        for (const Surface &surface : surfaces.pixel(pixel))
            if (surface.seen_by_centre() && surface.samples.back().view != 0 &&
                centre.plain(surface.samples[0].x, surface.samples[0].y))
                compare(views, centre, options, surface, blocks[block_of(pixel)]);
    std::vector<bool> agree(surfaces.pixels());
    for (std::size_t pixel = 0; pixel < surfaces.pixels(); ++pixel)
        agree[pixel] = blocks[block_of(pixel)].agrees();
    return agree;
}

} // namespace sparselens
