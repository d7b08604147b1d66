#include "ldi/warp.h"

#include "base/error.h"
#include "base/parallel.h"
#include "ldi/build.h"
#include "ldi/reproject.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <compare>
#include <numeric>

namespace sparselens {

namespace {

constexpr int band_rows = 16;
constexpr int most_overscan = 1024; // pixels an LDI grows beyond the centre view on a side

// A pixel of a view at its place in the centre view.
struct PlacedSample : ReprojectedSample {
    std::uint32_t view; // 0 is the centre
};

class Warper {
public:
    Warper(std::span<const View> views, const WarpOptions &options);
    Ldi run(Progress &progress) const;

private:
    Ldi warp_band(int first_row, int last_row) const;
    std::vector<PlacedSample> collect(int first_row, int last_row, std::vector<std::size_t> &begin) const;
    void emit_pixel(std::span<PlacedSample> samples, Ldi &out) const;
    std::size_t emit_centre_surface(std::span<PlacedSample> samples, std::vector<PlacedSample> &group, Ldi &out) const;
    void emit_surface(std::span<const PlacedSample> group, Ldi &out) const;

    double depth_of(const PlacedSample &s) const { return scale_ * double(s.inverse_z); }
    bool one_surface(const PlacedSample &a, const PlacedSample &b) const {
        return std::abs(depth_of(a) - depth_of(b)) < options_.surface_px || a.inverse_z == b.inverse_z;
    }
    float value(const PlacedSample &s, std::size_t channel) const {
        return views_[s.view]->image.plane(source_channel_[s.view][channel])[s.source];
    }

    std::vector<const View *> views_; // the centre, then the rim views in a canonical order
    WarpOptions options_;
    double scale_; // R F: perceptive depth is scale / z
    std::vector<std::vector<std::size_t>> source_channel_; // [view][centre channel]
    std::vector<Reprojection> reprojections_;
    Ldi layout_; // windows and channels of the result
};

void check(const View &centre, const View &view) {
    if (view.image.windows.display != centre.image.windows.display)
        throw Error(view.name + ": its display window differs from the centre view's (" + centre.name + ")");
    for (const Channel &channel : centre.image.channels)
        if (find_channel(view.image.channels, channel.name) == npos)
            throw Error(view.name + ": has no channel " + channel.name + ", which the centre view has");
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
    for (const View &view : views) {
        check(views[0], view);
        views_.push_back(&view);
    }
    std::sort(views_.begin() + 1, views_.end(), canonically_before);
    layout_.windows = views[0].image.windows;
    layout_.channels = views[0].image.channels;
    layout_.values.resize(layout_.channels.size());
    for (const View *view : views_) {
        reprojections_.emplace_back(*view, options.focal_px);
        source_channel_.emplace_back();
        for (const Channel &channel : layout_.channels)
            source_channel_.back().push_back(find_channel(view->image.channels, channel.name));
        if (options.merge == Merge::average) layout_.windows.data.extendBy(reprojections_.back().reach());
    }
    Imath::Box2i most = views[0].image.windows.data;
    most.min -= Imath::V2i(most_overscan);
    most.max += Imath::V2i(most_overscan);
    Imath::Box2i &data = layout_.windows.data;
    for (int axis = 0; axis < 2; ++axis) {
        data.min[axis] = std::max(data.min[axis], most.min[axis]);
        data.max[axis] = std::min(data.max[axis], most.max[axis]);
    }
}

// The samples of all views that fall in the rows, pixel by pixel: pixel i of the rows has [begin[i], begin[i + 1]).
std::vector<PlacedSample> Warper::collect(int first_row, int last_row, std::vector<std::size_t> &begin) const {
    const Imath::Box2i &data = layout_.windows.data;
    const std::size_t width = std::size_t(layout_.windows.width());
    const auto pixel_of = [&](const ReprojectedSample &s) {
        return std::size_t(s.y - first_row) * width + std::size_t(s.x - data.min.x);
    };
    std::vector<std::vector<ReprojectedSample>> landed(views_.size());
    begin.assign(width * std::size_t(last_row - first_row + 1) + 1, 0);
    for (std::size_t v = 0; v < views_.size(); ++v) {
        reprojections_[v].append_rows(first_row, last_row, landed[v]);
        std::erase_if(landed[v], [&](const auto &s) { return s.x < data.min.x || s.x > data.max.x; });
        for (const ReprojectedSample &s : landed[v]) ++begin[pixel_of(s) + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<PlacedSample> samples(begin.back());
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (std::uint32_t v = 0; v < views_.size(); ++v)
        for (const ReprojectedSample &s : landed[v]) samples[next[pixel_of(s)]++] = {s, v};
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
    const double count = double(group.size());
    double dx = 0, dy = 0, inverse_z = 0; // double: views may be many, depths near each other
    for (const PlacedSample &s : group) {
        dx += double(s.dx);
        dy += double(s.dy);
        inverse_z += double(s.inverse_z);
    }
    const bool alone = group.size() == 1;
    out.z.push_back(alone ? views_[group[0].view]->z[group[0].source] : float(count / inverse_z));
    out.dx.push_back(float(dx / count));
    out.dy.push_back(float(dy / count));
    out.weight.push_back(float(count));
    for (std::size_t k = 0; k < out.channels.size(); ++k) {
        double sum = 0;
        for (const PlacedSample &s : group) sum += double(value(s, k));
        const bool copied = alone || out.channels[k].type == PixelType::uint32;
        out.values[k].push_back(copied ? value(group[0], k) : float(sum / count));
    }
    ++out.begin.back();
}

// Emits the surface that the centre view shows and returns how many of the samples (sorted front to back) are
// done with: those in front of it too, as nothing that the centre view does not show lies there.
std::size_t Warper::emit_centre_surface(std::span<PlacedSample> samples, std::vector<PlacedSample> &group,
                                        Ldi &out) const {
    const auto centre = std::find_if(samples.begin(), samples.end(), [](const auto &s) { return s.view == 0; });
    if (centre == samples.end()) return 0;
    group.clear();
    std::size_t done = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const bool same = one_surface(samples[i], *centre);
        if (same) group.push_back(samples[i]);
        if (same || i < std::size_t(centre - samples.begin())) done = i + 1;
    }
    std::stable_sort(group.begin(), group.end(), [](const auto &a, const auto &b) { return a.view < b.view; });
    emit_surface(group, out);
    return done;
}

void Warper::emit_pixel(std::span<PlacedSample> samples, Ldi &out) const {
    const Imath::V2i pixel(samples.empty() ? Imath::V2i(0) : Imath::V2i(samples[0].x, samples[0].y));
    std::stable_sort(samples.begin(), samples.end(),
                     [](const auto &a, const auto &b) { return a.inverse_z > b.inverse_z; });
    std::vector<PlacedSample> group;
    std::size_t first = emit_centre_surface(samples, group, out);
    // An empty pixel of the centre view is transparent to infinity; outside of it nothing is known.
    if (first == 0 && views_[0]->image.windows.data.intersects(pixel)) return;
    for (std::size_t last = first; first < samples.size(); first = last) {
        while (last < samples.size() && one_surface(samples[first], samples[last])) ++last;
        group.assign(samples.begin() + std::ptrdiff_t(first), samples.begin() + std::ptrdiff_t(last));
        std::stable_sort(group.begin(), group.end(), [](const auto &a, const auto &b) { return a.view < b.view; });
        emit_surface(group, out);
    }
}

Ldi Warper::warp_band(int first_row, int last_row) const {
    std::vector<std::size_t> begin;
    std::vector<PlacedSample> samples = collect(first_row, last_row, begin);
    Ldi out = empty_like(layout_);
    out.begin.push_back(0);
    for (std::size_t pixel = 0; pixel + 1 < begin.size(); ++pixel) {
        out.begin.push_back(out.begin.back());
        emit_pixel(std::span(samples).subspan(begin[pixel], begin[pixel + 1] - begin[pixel]), out);
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
