#include "warp/images/image_depths.h"

#include "base/channel_kind.h"
#include "base/grid.h"
#include "base/numbers.h"
#include "kernels/warp_rules.h"
#include "lens/thin_lens.h"
#include "warp/tuning.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace sparselens {

namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
constexpr int near_by = WarpTuning::image_plane_reach, farther = WarpTuning::image_continued_reach;

// Disparities of pixels, by the numbers that the search gives them; NaN: not known.
using Depths = std::vector<float>;

// Makes depths of what the search found, in steps. Each step makes the depths of a block from what the step before made
// of that block and of those around it.
class ImageDepths {
public:
    explicit ImageDepths(const ImageSearch &search)
        : search_(search), sweep_(search.sweep()), matches_(search.matches),
          tried_(matches_.size(), unknown) {}

    void find(const ShowImages &show);

private:
    void agree_with_neighbours(const Imath::Box2i &tile, const Depths &from, Depths &to) const;
    void refine(const Imath::Box2i &tile, const Depths &from, Depths &to) const;
    void go_on(const Imath::Box2i &tile, const Depths &from, Depths &to);
    Neighbours neighbours(const Imath::Box2i &tile, const Depths &depths) const;
    float depth_at(const Imath::V2i &pixel, const Depths &depths) const {
        const std::size_t index = search_.index_of(pixel);
        return index == npos ? unknown : depths[index];
    }

    const ImageSearch &search_;
    const ImageSweep &sweep_;
    const std::vector<ImageMatch> &matches_;
    Depths tried_; // the last depth at which the views did not agree
};

// Returns what is known of the pixels of a tile and around it.
Neighbours ImageDepths::neighbours(const Imath::Box2i &tile, const Depths &depths) const {
    return Neighbours([&](const Imath::V2i &place) -> Neighbours::Pixel {
        const std::size_t index = search_.index_of(tile.min + place);
        if (index == npos) return {unknown, unknown};
        return {matches_[index].own_depth, depths[index]};
    });
}

// Returns the depth on the plane that fits those depths around that are close enough to `depth` to belong to one image;
// unknown if they are too few.
float depth_on_plane(const Neighbours &neighbours, const Imath::V2i &place, float depth, std::size_t around) {
    LinearFit fit;
    neighbours.for_each_around(place, near_by, [&](const Imath::V2i &offset, float other) {
        if (std::abs(other - depth) <= WarpTuning::image_one_px) fit.add(Imath::V2d(offset), double(other));
    });
    return fit.count() >= WarpTuning::image_agreement * double(around) ? float(fit.at_origin()) : unknown;
}

// Returns the depth on a plane through depths near the pixel's own depth, else near the median of the depths around;
// unknown if those are too few.
float depth_by_neighbours(const Neighbours &neighbours, const Imath::V2i &place, std::vector<float> &around) {
    around.clear();
    std::size_t pixels = 0;
    neighbours.for_each_around(place, near_by, [&](const Imath::V2i &, float depth) {
        ++pixels;
        if (!std::isnan(depth)) around.push_back(depth);
    });
    if (double(around.size()) < WarpTuning::image_agreement * double(pixels)) return unknown;
    const float own = depth_on_plane(neighbours, place, neighbours.depth(place), around.size());
    return std::isnan(own) ? depth_on_plane(neighbours, place, median(around), around.size()) : own;
}

void ImageDepths::agree_with_neighbours(const Imath::Box2i &tile, const Depths &from, Depths &to) const {
    const Neighbours around_tile = neighbours(tile, from);
    std::vector<float> around;
    const Grid pixels(tile);
    for (std::size_t n = 0; n < pixels.size(); ++n) {
        const Imath::V2i pixel = pixels.pixel(n);
        const std::size_t index = search_.index_of(pixel);
        to[index] =
            std::isnan(from[index]) ? unknown : depth_by_neighbours(around_tile, pixel - tile.min, around);
    }
}

// Refines depths. Unlike in the search, a patch need not lie at one depth.
void ImageDepths::refine(const Imath::Box2i &tile, const Depths &from, Depths &to) const {
    const std::vector<float> refined =
        sweep_.refined(tile, [&](const Imath::V2i &p) { return depth_at(p, from); });
    const Grid pixels(tile);
    for (std::size_t n = 0; n < pixels.size(); ++n) to[search_.index_of(pixels.pixel(n))] = refined[n];
}

// The median of the depths around; unknown if those are too few.
float depth_around(const Neighbours &neighbours, const Imath::V2i &place, std::vector<float> &around) {
    around.clear();
    neighbours.for_each_around(place, farther, [&](const Imath::V2i &, float depth) {
        if (!std::isnan(depth)) around.push_back(depth);
    });
    return around.size() < WarpTuning::image_least_sources ? unknown : median(around);
}

// Whether a pixel's surface lies on the plane through the surfaces around that show an image.
bool lies_on_mirror(const Neighbours &neighbours, const Imath::V2i &place) {
    LinearFit fit;
    neighbours.for_each_around(place, farther, [&](const Imath::V2i &offset, float depth) {
        if (!std::isnan(depth)) fit.add(Imath::V2d(offset), double(neighbours.own_depth(place + offset)));
    });
    return std::abs(fit.at_origin() - double(neighbours.own_depth(place))) <= WarpTuning::image_off_mirror_px;
}

// Continues depths to pixels of the same surface, if the views agree there about as well as on the surface. Where they
// cannot be compared (on edges, and where a steep mirror leaves the surface of its block), the pixel must lie on the
// mirror.
void ImageDepths::go_on(const Imath::Box2i &tile, const Depths &from, Depths &to) {
    const Neighbours around_tile = neighbours(tile, from);
    const Grid pixels(tile);
    std::vector<float> around, depths(pixels.size(), unknown);
    std::array<Neighbours::Pixel, image_block * image_block / 4> of_four;
    of_four.fill({unknown, unknown}); // pixels side by side have the same pixels around them
    for (std::size_t n = 0; n < pixels.size(); ++n) {
        const std::size_t index = search_.index_of(pixels.pixel(n));
        to[index] = from[index];
        if (std::isnan(matches_[index].own_depth) || !std::isnan(from[index])) continue;
        const Imath::V2i place = pixels.pixel(n) - tile.min;
        auto &[own, depth] = of_four[std::size_t(place.y / 2 * (image_block / 2) + place.x / 2)];
        if (!kernels::is_one_surface(own, matches_[index].own_depth, one_mirror_px)) {
            own = matches_[index].own_depth;
            depth = depth_around(around_tile, place, around);
        }
        if (depth != tried_[index]) depths[n] = tried_[index] = depth;
    }
    if (std::ranges::all_of(depths, [](float depth) { return std::isnan(depth); })) return;
    const auto tried_at = [&](const Imath::V2i &p) {
        const float depth = tile.intersects(p) ? depths[pixels.index(p)] : unknown;
        return std::isnan(depth) ? depth_at(p, from) : depth;
    };
    const std::vector<float> means = robust_means(sweep_.differences(tile, tried_at), pixels.size());
    for (std::size_t n = 0; n < pixels.size(); ++n) {
        if (std::isnan(depths[n])) continue;
        const std::size_t index = search_.index_of(pixels.pixel(n));
        const ImageMatch &match = matches_[index];
        const float most = WarpTuning::image_continued_difference * match.at_surface +
                           WarpTuning::image_continued_least_difference;
        const bool compared = match.surface && !std::isnan(means[n]);
        const bool shows =
            compared ? means[n] <= most : lies_on_mirror(around_tile, pixels.pixel(n) - tile.min);
        if (shows) to[index] = depths[n];
    }
}

// Each step follows the one before down the picture, a band behind it, so that they read the same tiles of the views.
void ImageDepths::find(const ShowImages &show) {
    constexpr std::size_t made = 3 + WarpTuning::image_continuations, // steps that make depths
        // rows of blocks; a step looks one row beyond
        band_rows = 2;
    std::array<Depths, 3> depths; // a later step overwrites what a step reads of a band
    depths.fill(Depths(matches_.size(), unknown));
    for (std::size_t i = 0; i < matches_.size(); ++i)
        if (matches_[i].found) depths[0][i] = matches_[i].depth;
    const auto take = [&](std::size_t step, const Imath::Box2i &tile) {
        const Depths &from = depths[step % 3];
        Depths &to = depths[(step + 1) % 3];
        if (step == made) return show(tile, [&](const Imath::V2i &pixel) { return depth_at(pixel, from); });
        if (step == 1) return refine(tile, from, to);
        if (step < 3) return agree_with_neighbours(tile, from, to);
        go_on(tile, from, to);
    };
    const std::size_t bands = search_.bands(band_rows);
    for (std::size_t time = 0; time < bands + made; ++time)
        for (std::size_t step = time - std::min(time, bands - 1); step <= std::min(time, made); ++step)
            search_.for_each_searched(band_rows, time - step,
                                      [&](const Imath::Box2i &tile) { take(step, tile); });
}

} // namespace

std::vector<std::size_t> blocks_to_search(const Imath::Box2i &data, std::span<const Disagreement> differ) {
    const Tiles tiles(data, image_block);
    std::vector<std::size_t> blocks;
    for (std::size_t tile = 0; tile < tiles.count(); ++tile) {
        int beside = 0;
        for_each_beside(tiles, tile,
                        [&](std::size_t other) { beside += differ[other] != Disagreement::none; });
        const bool clear = differ[tile] == Disagreement::clear, slight = differ[tile] == Disagreement::slight;
        if ((clear && beside > 0) || (slight && beside >= WarpTuning::image_enough_beside))
            blocks.push_back(tile);
    }
    return blocks;
}

void find_image_depths(const ImageSweep &sweep, const Imath::Box2i &data,
                       const std::vector<std::size_t> &blocks, const ShowImages &show) {
    const ImageSearch search(sweep, data, blocks);
    ImageDepths(search).find(show);
}

namespace {

// A sample of a view that shows an image, at its position in the pixel of the centre view.
struct ImageSample {
    const ViewSamples *view;
    std::uint64_t index;
    double dx, dy, weight;
};

class Shower {
public:
    Shower(std::span<const MatchedView> views, const ImageSweep &sweep, double scale, Ldi &ldi)
        : views_(views), sweep_(sweep), scale_(scale), ldi_(ldi), alpha_(ldi.alpha()) {}

    // Gives the front samples of a block's pixels their images. Returns whether there is one.
    bool show(const Imath::Box2i &block, const ImageDepthAt &depth_at) const {
        const Grid pixels(block);
        std::vector<float> own(pixels.size());
        for (std::size_t n = 0; n < own.size(); ++n) own[n] = depth_at(pixels.pixel(n));
        if (std::ranges::all_of(own, [](float depth) { return std::isnan(depth); })) return false;
        const std::vector<float> differences = sweep_.differences(block, depth_at),
                                 usual = robust_means(differences, own.size());
        for (std::size_t n = 0; n < own.size(); ++n) {
            if (std::isnan(own[n])) continue;
            const Imath::V2i pixel = pixels.pixel(n);
            std::vector<ImageSample> seen{centre(pixel)};
            for (std::size_t v = 1; v < views_.size(); ++v)
                if (differences[(v - 1) * own.size() + n] <=
                    WarpTuning::image_shown_difference * usual[n] + WarpTuning::image_shown_least_difference)
                    add(views_[v], pixel, double(own[n]), seen);
            store(ldi_.pixel(ldi_.windows.index(pixel)).front(), double(own[n]), seen);
        }
        return true;
    }

private:
    ImageSample centre(const Imath::V2i &pixel) const {
        const ViewSamples &view = views_[0].samples();
        const std::uint64_t i = view.pixel(view.windows.index(pixel)).front();
        return {&view, i, 0, 0, double(view.weight(i))};
    }

    // Adds the pixel of a view that is nearest to where the view shows the image, if it shows the same surface.
    void add(const MatchedView &view, const Imath::V2i &pixel, double depth,
             std::vector<ImageSample> &seen) const {
        const double inverse_z = depth / scale_;
        const Imath::V2d middle(pixel.x + 0.5, pixel.y + 0.5), place = view.in_view(middle, depth);
        const Imath::V2i q(int(std::floor(place.x)), int(std::floor(place.y)));
        if (!view.contains(q)) return;
        const float own = views_[0].depth(pixel.x, pixel.y);
        if (!kernels::is_one_surface(view.depth(q.x, q.y), own, one_mirror_px)) return;
        const Imath::V2d from(q.x + 0.5, q.y + 0.5);
        const Imath::V2d off =
            view.mapping().at_infinity(from) + view.mapping().parallax(from) * inverse_z - middle;
        if (!(std::abs(off.x) <= 0.5 && std::abs(off.y) <= 0.5)) return;
        const ViewSamples &samples = view.samples();
        const std::uint64_t i = samples.pixel(samples.windows.index(q)).front();
        seen.push_back(
            {&samples, i, off.x, off.y, double(samples.weight(i)) * kernels::nearness(off.x, off.y)});
    }

    void store(std::uint64_t i, double depth, const std::vector<ImageSample> &seen) const {
        double total = 0, dx = 0, dy = 0, count = 0;
        for (const ImageSample &s : seen) {
            total += s.weight;
            dx += s.weight * s.dx;
            dy += s.weight * s.dy;
            count += double(s.view->weight(s.index));
        }
        ldi_.dx[i] = float(dx / total);
        ldi_.dy[i] = float(dy / total);
        ldi_.weight[i] = float(count);
        ldi_.z[i] = seen[0].view->z(seen[0].index);
        if (!ldi_.z_back.empty()) ldi_.z_back[i] = ldi_.z[i];
        ldi_.image_z[i] = float(depth_at_disparity(scale_, depth));
        for (std::size_t k = 0; k < ldi_.channels.size(); ++k) {
            double sum = 0;
            const bool light = is_light(ldi_.channels[k]) && k != alpha_;
            for (const ImageSample &s : seen) sum += s.weight * double(s.view->value(k, s.index));
            ldi_.values[k][i] = light ? float(sum / total) : seen[0].view->value(k, seen[0].index);
        }
    }

    std::span<const MatchedView> views_;
    const ImageSweep &sweep_;
    double scale_;
    Ldi &ldi_;
    std::size_t alpha_;
};

} // namespace

void show_images(std::span<const PlacedView> views, double scale, int across,
                 std::span<const Disagreement> differ, Ldi &ldi) {
    const std::vector<std::size_t> blocks = blocks_to_search(ldi.windows.data, differ);
    if (blocks.empty()) return;
    std::vector<MatchedView> matched;
    matched.reserve(views.size());
    for (const PlacedView &view : views) matched.emplace_back(view, scale);
    const ImageSweep sweep(matched, kernels::motion_unit(across));
    ldi.image_z = ldi.z;
    const Shower shower(matched, sweep, scale, ldi);
    std::atomic<bool> shown = false;
    find_image_depths(sweep, ldi.windows.data, blocks,
                      [&](const Imath::Box2i &block, const ImageDepthAt &depth_at) {
                          if (shower.show(block, depth_at)) shown = true;
                      });
    if (!shown) std::vector<float>().swap(ldi.image_z);
}

} // namespace sparselens
