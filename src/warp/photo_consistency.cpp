#include "warp/photo_consistency.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sparselens {

namespace {

constexpr double least_ratio = 3;         // noise alone gives up to 1.6, edges of texture up to 2
constexpr double least_difference = 1e-5; // mean square, tone-mapped: less is not seen
constexpr double least_motion = 0.3;      // pixels of perceptive depth
constexpr double clear_motion = 0.5;      // the same; sharp edges seem to move by less
constexpr double least_explained = 0.5;   // share of the squared differences; noise alone gives a hundredth
constexpr double least_change = 1e-5;     // mean square for each pixel of depth: nothing else tells
constexpr double focus_px = 2;            // CoC up to which a surface counts as in focus

// What a block of pixels has shown so far.
struct Block {
    double difference = 0, variation = 0; // sums of squares over channels
    double coc = 0;                       // sum of |CoC|
    double pixels = 0;
    // Of each sample of a rim view and channel: the difference, and how it changes with the depth of the picture, which is
    // the gradient along the way that the picture moves.
    double change2 = 0, change_difference = 0, difference2 = 0, values = 0;

    void add_motion(double moved_difference, double change) {
        change2 += change * change;
        change_difference += change * moved_difference;
        difference2 += moved_difference * moved_difference;
        values += 1;
    }
    bool differs() const { return difference > least_ratio * variation + least_difference * pixels; }
    // By how much a depth that is not that of the surface would explain much of the difference, by linear regression.
    double motion() const {
        if (!(change2 > least_change * values)) return 0;
        const double moved = change_difference / change2, explained = moved * change_difference;
        return explained >= least_explained * difference2 ? std::abs(moved) : 0;
    }
    Disagreement disagreement() const {
        const double moved = motion();
        if (differs() || moved >= clear_motion) return Disagreement::clear;
        return moved >= least_motion ? Disagreement::slight : Disagreement::none;
    }
    bool in_focus() const { return coc <= focus_px * pixels; }
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
    // A value, the mean of the four around it, and the gradient.
    struct Detail {
        double value, mean_around;
        Imath::V2d gradient;
    };
    Detail detail(int x, int y, std::size_t channel) const {
        std::array<double, 4> beside;
        std::ranges::transform(around(x, y), beside.begin(),
                               [&](std::size_t i) { return value_at(i, channel); });
        const auto [left, right, above, below] = beside;
        return {value_at(grid_.index(x, y), channel), (left + right + above + below) / 4,
                Imath::V2d(right - left, below - above) / 2};
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

void compare(const ReprojectedViews &views, const CentreColours &centre,
             const PhotoConsistencyOptions &options, const Surface &surface, Block &block) {
    const int x = surface.samples[0].x, y = surface.samples[0].y;
    const Imath::V2d place(x + 0.5, y + 0.5);
    const std::size_t channels = centre.channels().size();
    std::array<CentreColours::Detail, 3> own;
    std::array<double, 3> sum{};
    for (std::size_t k = 0; k < channels; ++k) own[k] = centre.detail(x, y, centre.channels()[k]);
    double total = 0;
    for (const ViewSample &s : surface.samples) {
        if (s.view == 0) continue;
        total += s.weight;
        const Imath::V2d off(double(s.dx), double(s.dy)),
            motion = views.reprojection(s.view).mapping().parallax(place) * (1 / options.scale);
        for (std::size_t k = 0; k < channels; ++k) {
            const double value = tone_mapped(views.value(s, centre.channels()[k]));
            sum[k] += s.weight * value;
            block.add_motion(value - own[k].value - (own[k].gradient ^ off), own[k].gradient ^ motion);
        }
    }
    for (std::size_t k = 0; k < channels; ++k) {
        const double difference = sum[k] / total - own[k].value,
                     variation = own[k].mean_around - own[k].value;
        block.difference += difference * difference;
        block.variation += variation * variation;
    }
    constexpr double out_of_focus = 2 * focus_px;
    block.coc +=
        options.lens ? std::abs(circle_of_confusion(*options.lens, 1 / surface.inverse_z)) : out_of_focus;
    block.pixels += 1;
}

} // namespace

PhotoConsistency find_photo_consistency(const ReprojectedViews &views, const PhotoConsistencyOptions &options,
                                        const Imath::Box2i &data, const Surfaces &surfaces) {
    const int width = Grid(data).width();
    const Grid grid(width, int(surfaces.pixels() / std::size_t(width)));
    const Tiles tiles(grid.box(), photo_block);
    const auto block_of = [&](std::size_t pixel) { return tiles.tile_of(grid.pixel(pixel)); };
    const CentreColours centre(views.samples(0));
    std::vector<Block> blocks(tiles.count());
    for (std::size_t pixel = 0; pixel < surfaces.pixels(); ++pixel)
        for (const Surface &surface : surfaces.pixel(pixel))
            if (surface.seen_by_centre() && surface.samples.back().view != 0 &&
                centre.plain(surface.samples[0].x, surface.samples[0].y))
                compare(views, centre, options, surface, blocks[block_of(pixel)]);
    PhotoConsistency found{std::vector<bool>(surfaces.pixels()),
                           std::vector<Disagreement>(surfaces.pixels())};
    for (std::size_t pixel = 0; pixel < surfaces.pixels(); ++pixel) {
        const Block &block = blocks[block_of(pixel)];
        found.differ[pixel] = block.disagreement();
        found.averages[pixel] = !block.differs() || block.in_focus();
    }
    return found;
}

} // namespace sparselens
