#include "warp/photo_consistency.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sparselens {

namespace {

class CentreColours {
public:
    explicit CentreColours(const ViewSamples &centre) : centre_(centre), grid_(centre.windows.grid()) {
        for (const std::size_t channel : find_rgb(centre.channels))
            if (channel != npos) channels_.push_back(channel);
    }
    std::span<const std::size_t> channels() const { return channels_; }

    // Whether the pixel and the four around it show one sample each: their variation is that of one picture.
    bool plain(int x, int y) const {
        const Imath::Box2i &data = centre_.windows.data;
        if (x <= data.min.x || x >= data.max.x || y <= data.min.y || y >= data.max.y) return false;
        return single(grid_.index(Imath::V2i(x, y))) &&
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
        return {value_at(grid_.index(Imath::V2i(x, y)), channel), (left + right + above + below) / 4,
                Imath::V2d(right - left, below - above) / 2};
    }

private:
    std::array<std::size_t, 4> around(int x, int y) const {
        return {grid_.index(Imath::V2i(x - 1, y)), grid_.index(Imath::V2i(x + 1, y)),
                grid_.index(Imath::V2i(x, y - 1)), grid_.index(Imath::V2i(x, y + 1))};
    }
    bool single(std::size_t i) const { return centre_.is_single(i); }
    double value_at(std::size_t i, std::size_t channel) const {
        return kernels::bounded(double(centre_.value(channel, centre_.pixel(i).front())));
    }

    const ViewSamples &centre_;
    Grid grid_;
    std::vector<std::size_t> channels_;
};

void compare(const ReprojectedViews &views, const CentreColours &centre,
             const PhotoConsistencyOptions &options, const Surface &surface, kernels::PhotoBlock &block) {
    const int x = surface.samples[0].x, y = surface.samples[0].y;
    const Imath::V2d place(x + 0.5, y + 0.5);
    const std::size_t channels = centre.channels().size();
    std::array<CentreColours::Detail, 3> own;
    std::array<double, 3> sum{};
    for (std::size_t k = 0; k < channels; ++k) own[k] = centre.detail(x, y, centre.channels()[k]);
    double total = 0;
    for (const ViewSample &s : surface.samples) {
        if (s.view == 0 || views.samples(s.view).is_part(s.source)) continue; // a part shows only its share
        total += s.weight;
        const Imath::V2d off(double(s.dx), double(s.dy)),
            motion = views.reprojection(s.view).mapping().parallax(place) * (1 / options.scale);
        for (std::size_t k = 0; k < channels; ++k) {
            const double value = kernels::bounded(double(views.value(s, centre.channels()[k])));
            sum[k] += s.weight * value;
            kernels::add_motion(block, value - own[k].value - (own[k].gradient ^ off),
                                own[k].gradient ^ motion);
        }
    }
    if (total == 0) return;
    for (std::size_t k = 0; k < channels; ++k)
        kernels::add_channel(block, sum[k] / total - own[k].value, own[k].mean_around - own[k].value);
    constexpr double out_of_focus = 2 * kernels::focus_px;
    kernels::add_pixel(block, options.lens
                                  ? std::abs(circle_of_confusion(*options.lens, 1 / surface.inverse_z))
                                  : out_of_focus);
}

} // namespace

Disagreement disagreement_of(std::uint32_t verdict) {
    if (verdict & kernels::differs_clearly) return Disagreement::clear;
    return verdict & kernels::differs_slightly ? Disagreement::slight : Disagreement::none;
}

PhotoConsistency find_photo_consistency(const ReprojectedViews &views, const PhotoConsistencyOptions &options,
                                        const Imath::Box2i &data, const Surfaces &surfaces) {
    const int width = Grid(data).width();
    const ArrayGrid grid(width, int(surfaces.pixels() / std::size_t(width)));
    const Tiles tiles(grid.box(), kernels::photo_block);
    const auto block_of = [&](std::size_t pixel) { return tiles.tile_of(grid.position(pixel)); };
    const CentreColours centre(views.samples(0));
    std::vector<kernels::PhotoBlock> blocks(tiles.count());
    for (std::size_t pixel = 0; pixel < surfaces.pixels(); ++pixel)
        for (const Surface &surface : surfaces.pixel(pixel))
            if (surface.seen_by_centre() && surface.samples.back().view != 0 &&
                centre.plain(surface.samples[0].x, surface.samples[0].y))
                compare(views, centre, options, surface, blocks[block_of(pixel)]);
    std::vector<std::uint32_t> verdicts(blocks.size());
    std::ranges::transform(blocks, verdicts.begin(), [&](const kernels::PhotoBlock &block) {
        return kernels::photo_verdict(block, kernels::motion_unit(options.across));
    });
    PhotoConsistency found{std::vector<bool>(surfaces.pixels()),
                           std::vector<Disagreement>(surfaces.pixels())};
    for (std::size_t pixel = 0; pixel < surfaces.pixels(); ++pixel) {
        const std::uint32_t verdict = verdicts[block_of(pixel)];
        found.differ[pixel] = disagreement_of(verdict);
        found.averages[pixel] = (verdict & kernels::may_average) != 0;
    }
    return found;
}

} // namespace sparselens
