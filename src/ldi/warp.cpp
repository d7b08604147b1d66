#include "ldi/warp.h"

#include "base/error.h"
#include "base/parallel.h"
#include "ldi/build.h"
#include "ldi/reproject.h"
#include "ldi/silhouettes.h"
#include "ldi/view_samples.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <compare>
#include <memory>
#include <numeric>

namespace sparselens {

namespace {

constexpr int band_rows = 16;
constexpr int most_overscan = 1024; // pixels an LDI grows beyond the centre view on a side

// A sample of a view at its place in the centre view.
struct PlacedSample : ReprojectedSample {
    std::uint32_t view;    // 0 is the centre
    std::uint32_t surface; // of the pixel, as find_surfaces() numbers them
};

// A view as the warp works on it: its samples, silhouettes taken apart where views are averaged.
struct Source {
    Ldi ldi;
    Reprojection reprojection; // refers to ldi

    Source(Ldi samples, const Imath::V2d &position, double focal_px)
        : ldi(std::move(samples)), reprojection(ldi, position, focal_px) {}
};

// Reused from pixel to pixel.
struct Surfaces {
    struct Surface {
        std::vector<PlacedSample> samples;
        double inverse_z; // mean
    };
    std::vector<Surface> list;
    std::size_t count = 0;
};

class Warper {
public:
    Warper(std::span<const View> views, const WarpOptions &options);
    Ldi run(Progress &progress) const;

private:
    void limit_window(const Imath::Box2i &centre);
    Ldi warp_band(int first_row, int last_row) const;
    std::vector<PlacedSample> collect(int first_row, int last_row, std::vector<std::size_t> &begin) const;
    std::span<PlacedSample> behind_centre(std::span<PlacedSample> samples) const;
    void find_surfaces(std::span<PlacedSample> samples, Surfaces &surfaces) const;
    void emit_surface(std::span<const PlacedSample> group, Ldi &out) const;

    bool one_surface(const PlacedSample &a, const PlacedSample &b) const {
        return std::abs(scale_ * (double(a.inverse_z) - double(b.inverse_z))) < options_.surface_px ||
               a.inverse_z == b.inverse_z;
    }
    float value(const PlacedSample &s, std::size_t channel) const {
        return sources_[s.view]->ldi.values[channel][s.source];
    }
    double weight(const PlacedSample &s) const;

    std::vector<std::unique_ptr<Source>> sources_; // the centre, then the rim views in a canonical order
    WarpOptions options_;
    double scale_; // R F: perceptive depth is scale / z
    Ldi layout_;   // windows and channels of the result
};

void check(const View &centre, const View &view) {
    if (view.image.windows.display != centre.image.windows.display)
        throw Error(view.name + ": its display window differs from the centre view's (" + centre.name + ")");
}

// By position; where several stand at one point, by what they show: the order they were given in must not matter.
bool canonically_before(const View *a, const View *b) {
    if (a->position.x != b->position.x) return a->position.x < b->position.x;
    if (a->position.y != b->position.y) return a->position.y < b->position.y;
    const auto by_bits = [](const std::vector<float> &left, const std::vector<float> &right) {
        return std::lexicographical_compare_three_way(
            left.begin(), left.end(), right.begin(), right.end(), [](float l, float r) {
                return std::bit_cast<std::uint32_t>(l) <=> std::bit_cast<std::uint32_t>(r);
            });
    };
    const auto by_depth = by_bits(a->z, b->z);
    return by_depth != 0 ? by_depth < 0 : by_bits(a->image.values, b->image.values) < 0;
}

Warper::Warper(std::span<const View> views, const WarpOptions &options)
    : options_(options), scale_(options.radius * options.focal_px) {
    std::vector<const View *> ordered;
    for (const View &view : views) {
        check(views[0], view);
        ordered.push_back(&view);
    }
    std::sort(ordered.begin() + 1, ordered.end(), canonically_before);
    layout_.windows = views[0].image.windows;
    layout_.channels = views[0].image.channels;
    layout_.values.resize(layout_.channels.size());
    sources_.resize(ordered.size());
    parallel_for(ordered.size(), [&](std::size_t v) {
        Ldi samples = samples_of(*ordered[v], layout_.channels);
        if (options.merge == Merge::average && options.split_silhouettes && scale_ > 0)
            samples = separate_silhouettes(samples, scale_);
        sources_[v] = std::make_unique<Source>(std::move(samples), ordered[v]->position, options.focal_px);
    });
    if (options.merge == Merge::keep) return;
    for (const auto &source : sources_) layout_.windows.data.extendBy(source->reprojection.reach());
    limit_window(views[0].image.windows.data);
}

void Warper::limit_window(const Imath::Box2i &centre) {
    Imath::Box2i &data = layout_.windows.data;
    for (int axis = 0; axis < 2; ++axis) {
        data.min[axis] = std::max(data.min[axis], centre.min[axis] - most_overscan);
        data.max[axis] = std::min(data.max[axis], centre.max[axis] + most_overscan);
    }
}

// What a sample counts in the mean of its surface: a mean of pixels that lie apart is blurred, so the ones near the
// middle count more.
double Warper::weight(const PlacedSample &s) const {
    constexpr double spread = 0.3; // pixels; less is sharper, more averages more noise away
    const double distance = double(s.dx) * double(s.dx) + double(s.dy) * double(s.dy);
    return double(sources_[s.view]->ldi.weight[s.source]) * std::exp(-0.5 * distance / (spread * spread));
}

// The samples of all views that fall in the rows, pixel by pixel: pixel i of the rows has [begin[i], begin[i + 1]).
std::vector<PlacedSample> Warper::collect(int first_row, int last_row,
                                          std::vector<std::size_t> &begin) const {
    const Imath::Box2i &data = layout_.windows.data;
    const std::size_t width = std::size_t(layout_.windows.width());
    const auto pixel_of = [&](const ReprojectedSample &s) {
        return std::size_t(s.y - first_row) * width + std::size_t(s.x - data.min.x);
    };
    std::vector<std::vector<ReprojectedSample>> landed(sources_.size());
    begin.assign(width * std::size_t(last_row - first_row + 1) + 1, 0);
    for (std::size_t v = 0; v < sources_.size(); ++v) {
        sources_[v]->reprojection.append_rows(first_row, last_row, landed[v]);
        std::erase_if(landed[v], [&](const auto &s) { return s.x < data.min.x || s.x > data.max.x; });
        for (const ReprojectedSample &s : landed[v]) ++begin[pixel_of(s) + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<PlacedSample> samples(begin.back());
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (std::uint32_t v = 0; v < sources_.size(); ++v)
        for (const ReprojectedSample &s : landed[v]) samples[next[pixel_of(s)]++] = {s, v, 0};
    return samples;
}

// One sample for the view samples of one surface in one pixel: their mean, or in keep the centre's, else the most
// central one. The mean of positions belongs to the mean of colours: where colour is linear, nothing is blurred.
void Warper::emit_surface(std::span<const PlacedSample> group, Ldi &out) const {
    if (options_.merge == Merge::keep) {
        const auto off_centre = [](const PlacedSample &s) {
            return s.view == 0 ? -1.0f : s.dx * s.dx + s.dy * s.dy;
        };
        const auto best = std::min_element(group.begin(), group.end(), [&](const auto &a, const auto &b) {
            return off_centre(a) < off_centre(b);
        });
        group = group.subspan(std::size_t(best - group.begin()), 1);
    }
    double count = 0, total = 0, dx = 0, dy = 0,
           inverse_z = 0; // double: views may be many, depths near each other
    for (const PlacedSample &s : group) {
        count += double(sources_[s.view]->ldi.weight[s.source]);
        total += weight(s);
        dx += weight(s) * double(s.dx);
        dy += weight(s) * double(s.dy);
        inverse_z += weight(s) * double(s.inverse_z);
    }
    const bool alone = group.size() == 1;
    out.z.push_back(alone ? sources_[group[0].view]->ldi.z[group[0].source] : float(total / inverse_z));
    out.dx.push_back(float(dx / total));
    out.dy.push_back(float(dy / total));
    out.weight.push_back(float(count));
    for (std::size_t k = 0; k < out.channels.size(); ++k) {
        double sum = 0;
        for (const PlacedSample &s : group) sum += weight(s) * double(value(s, k));
        const bool copied = alone || out.channels[k].type == PixelType::uint32;
        out.values[k].push_back(copied ? value(group[0], k) : float(sum / total));
    }
    ++out.begin.back();
}

// Of the samples of a pixel, front to back, those that belong to it: nothing lies in front of what the centre view
// shows, nor where it shows nothing.
std::span<PlacedSample> Warper::behind_centre(std::span<PlacedSample> samples) const {
    const auto centre =
        std::find_if(samples.begin(), samples.end(), [](const auto &s) { return s.view == 0; });
    if (centre == samples.end()) {
        const bool inside = sources_[0]->ldi.windows.data.intersects(Imath::V2i(samples[0].x, samples[0].y));
        return inside ? samples.first(0) : samples;
    }
    const auto first =
        std::find_if(samples.begin(), centre, [&](const auto &s) { return one_surface(s, *centre); });
    return samples.subspan(std::size_t(first - samples.begin()));
}

// Sorts the samples of a pixel (front to back) by surface: first those of the centre's samples, then the rest.
void Warper::find_surfaces(std::span<PlacedSample> samples, Surfaces &surfaces) const {
    constexpr std::uint32_t none = ~0u;
    for (PlacedSample &s : samples) s.surface = none;
    surfaces.count = 0;
    for (const bool centre : {true, false})
        for (const PlacedSample &anchor : samples) {
            if (anchor.surface != none || (anchor.view == 0) != centre) continue;
            const auto number = std::uint32_t(surfaces.count++);
            if (surfaces.list.size() < surfaces.count) surfaces.list.emplace_back();
            auto &[group, inverse_z] = surfaces.list[number];
            group.clear();
            double total = 0;
            inverse_z = 0;
            for (PlacedSample &s : samples) {
                if (s.surface != none || !one_surface(s, anchor)) continue;
                s.surface = number;
                group.push_back(s);
                inverse_z += weight(s) * double(s.inverse_z);
                total += weight(s);
            }
            inverse_z /= total;
            std::stable_sort(group.begin(), group.end(),
                             [](const auto &a, const auto &b) { return a.view < b.view; });
        }
    std::sort(surfaces.list.begin(), surfaces.list.begin() + std::ptrdiff_t(surfaces.count),
              [](const auto &a, const auto &b) { return a.inverse_z > b.inverse_z; });
}

Ldi Warper::warp_band(int first_row, int last_row) const {
    std::vector<std::size_t> begin;
    std::vector<PlacedSample> samples = collect(first_row, last_row, begin);
    Ldi out = empty_like(layout_);
    out.begin.push_back(0);
    Surfaces surfaces;
    for (std::size_t pixel = 0; pixel + 1 < begin.size(); ++pixel) {
        out.begin.push_back(out.begin.back());
        std::span<PlacedSample> here =
            std::span(samples).subspan(begin[pixel], begin[pixel + 1] - begin[pixel]);
        if (here.empty()) continue;
        std::stable_sort(here.begin(), here.end(),
                         [](const auto &a, const auto &b) { return a.inverse_z > b.inverse_z; });
        find_surfaces(behind_centre(here), surfaces);
        for (std::size_t i = 0; i < surfaces.count; ++i) emit_surface(surfaces.list[i].samples, out);
    }
    return out;
}

Ldi Warper::run(Progress &progress) const {
    const Imath::Box2i &data = layout_.windows.data;
    const std::size_t bands = std::size_t(layout_.windows.height() + band_rows - 1) / band_rows;
    std::vector<Ldi> pieces(bands);
    progress.start("warping", bands);
    parallel_for(bands, [&](std::size_t band) {
        const int first_row = data.min.y + int(band) * band_rows;
        pieces[band] = warp_band(first_row, std::min(first_row + band_rows - 1, data.max.y));
        progress.advance();
    });
    return concatenate(layout_, pieces);
}

} // namespace

Ldi warp(std::span<const View> views, const WarpOptions &options, Progress &progress) {
    return Warper(views, options).run(progress);
}

} // namespace sparselens
