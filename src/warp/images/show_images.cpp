#include "warp/images/show_images.h"

#include "base/channel_kind.h"
#include "kernels/photo_rules.h"
#include "lens/perceptive_depth.h"
#include "warp/images/image_depths.h"
#include "warp/images/robust_mean.h"
#include "warp/tuning.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace sparselens {

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
            store(ldi_.pixel(ldi_.windows.index(pixel.x, pixel.y)).front(), double(own[n]), seen);
        }
        return true;
    }

private:
    ImageSample centre(const Imath::V2i &pixel) const {
        const ViewSamples &view = views_[0].samples();
        const std::uint64_t i = view.pixel(view.windows.index(pixel.x, pixel.y)).front();
        return {&view, i, 0, 0, double(view.weight(i))};
    }

    // Adds the pixel of a view that is nearest to where the view shows the image, if it shows the same surface.
    void add(const MatchedView &view, const Imath::V2i &pixel, double depth,
             std::vector<ImageSample> &seen) const {
        const double inverse_z = depth / scale_;
        const Imath::V2d middle(pixel.x + 0.5, pixel.y + 0.5), place = view.in_view(middle, depth);
        const Imath::V2i q(int(std::floor(place.x)), int(std::floor(place.y)));
        if (!view.contains(q.x, q.y)) return;
        const float own = views_[0].depth(pixel.x, pixel.y);
        if (!kernels::is_one_surface(view.depth(q.x, q.y), own, one_mirror_px)) return;
        const Imath::V2d from(q.x + 0.5, q.y + 0.5);
        const Imath::V2d off =
            view.mapping().at_infinity(from) + view.mapping().parallax(from) * inverse_z - middle;
        if (!(std::abs(off.x) <= 0.5 && std::abs(off.y) <= 0.5)) return;
        const ViewSamples &samples = view.samples();
        const std::uint64_t i = samples.pixel(samples.windows.index(q.x, q.y)).front();
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
        ldi_.optical[i] = float(depth_of_perceptive(scale_, depth));
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
    ldi.optical = ldi.z;
    const Shower shower(matched, sweep, scale, ldi);
    std::atomic<bool> shown = false;
    find_image_depths(sweep, ldi.windows.data, blocks,
                      [&](const Imath::Box2i &block, const ImageDepthAt &depth_at) {
                          if (shower.show(block, depth_at)) shown = true;
                      });
    if (!shown) std::vector<float>().swap(ldi.optical);
}

} // namespace sparselens
