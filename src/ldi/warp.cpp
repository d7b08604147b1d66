#include "ldi/warp.h"

#include "base/error.h"
#include "base/parallel.h"
#include "ldi/build.h"
#include "ldi/reproject.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sparselens {

namespace {

constexpr int band_rows = 16;

// A rim sample with the view it came from.
struct RimSample : ReprojectedSample {
    std::uint32_t view;
};

class Warper {
public:
    Warper(std::span<const View> views, const WarpOptions &options);
    Ldi run(Progress &progress) const;

private:
    struct Band;

    Ldi warp_band(int first_row, int last_row) const;
    void collect(Band &band) const;
    void splat_onto_centre(Band &band) const;
    void emit_pixel(const Band &band, int x, int y, std::span<const RimSample> extras, Ldi &out) const;
    void emit_centre(const Band &band, std::size_t pixel, Ldi &out) const;
    void emit_group(std::span<const RimSample> group, Ldi &out) const;

    bool has_centre(int x, int y) const;
    double centre_depth(int x, int y) const { return scale_ / double(centre_.z[index(x, y)]); }
    double depth_of(const RimSample &s) const { return scale_ * double(s.inverse_z); }
    bool same_surface(double a, double b) const { return std::abs(a - b) < options_.surface_px; }
    std::size_t index(int x, int y) const {
        const Windows &w = centre_.image.windows;
        return std::size_t(y - w.data.min.y) * std::size_t(w.width()) + std::size_t(x - w.data.min.x);
    }
    float value(const RimSample &s, std::size_t channel) const {
        return views_[s.view]->image.plane(source_channel_[s.view][channel])[s.source];
    }

    std::vector<const View *> views_; // rim views in a canonical order
    const View &centre_;
    WarpOptions options_;
    double scale_; // R F: perceptive depth is scale / z
    std::size_t alpha_;
    std::vector<std::vector<std::size_t>> source_channel_; // [view][centre channel]
    std::vector<Reprojection> reprojections_;
};

// What one run of rows needs while it is made.
struct Warper::Band {
    int first_row, last_row;
    std::vector<RimSample> extras;          // of no centre sample's surface
    std::vector<RimSample> matched;         // join the centre's samples
    std::vector<double> sums;               // [channel][pixel of the band]: double, as views may be many
    std::vector<double> weights;            // [pixel of the band]
};

void check(const View &centre, const View &view) {
    if (view.image.windows.display != centre.image.windows.display)
        throw Error(view.name + ": its display window differs from the centre view's (" + centre.name + ")");
    for (const Channel &channel : centre.image.channels)
        if (find_channel(view.image.channels, channel.name) == npos)
            throw Error(view.name + ": has no channel " + channel.name + ", which the centre view has");
}

Warper::Warper(std::span<const View> views, const WarpOptions &options)
    : centre_(views[0]), options_(options), scale_(options.radius * options.focal_px),
      alpha_(find_channel(views[0].image.channels, "A")) {
    for (const View &view : views.subspan(1)) {
        check(centre_, view);
        views_.push_back(&view);
    }
    std::stable_sort(views_.begin(), views_.end(), [](const View *a, const View *b) {
        return std::pair(a->position.x, a->position.y) < std::pair(b->position.x, b->position.y);
    });
    for (const View *view : views_) {
        reprojections_.emplace_back(*view, options.focal_px);
        source_channel_.emplace_back();
        for (const Channel &channel : centre_.image.channels)
            source_channel_.back().push_back(find_channel(view->image.channels, channel.name));
    }
}

bool Warper::has_centre(int x, int y) const {
    if (!centre_.image.windows.data.intersects(Imath::V2i(x, y))) return false;
    return alpha_ == npos || centre_.image.plane(alpha_)[index(x, y)] != 0;
}

// Sorts the rim samples that fall near the band into those of the centre's surfaces and the rest.
void Warper::collect(Band &band) const {
    std::vector<ReprojectedSample> landed;
    for (std::uint32_t v = 0; v < views_.size(); ++v) {
        landed.clear();
        reprojections_[v].append_rows(band.first_row - 1, band.last_row + 1, landed);
        for (const ReprojectedSample &sample : landed) {
            const RimSample s{sample, v};
            const bool known = has_centre(s.x, s.y);
            const double difference = known ? centre_depth(s.x, s.y) - depth_of(s) : 0;
            if (known && std::abs(difference) < options_.surface_px) {
                band.matched.push_back(s);
                continue;
            }
            const bool inside = s.y >= band.first_row && s.y <= band.last_row &&
                                centre_.image.windows.data.intersects(Imath::V2i(s.x, s.y));
            const bool hidden_from_centre = known && difference > 0;
            if (inside && (options_.merge == Merge::average || hidden_from_centre)) band.extras.push_back(s);
        }
    }
    std::stable_sort(band.extras.begin(), band.extras.end(), [&](const RimSample &a, const RimSample &b) {
        return std::tuple(a.y, a.x, -a.inverse_z) < std::tuple(b.y, b.x, -b.inverse_z);
    });
}

// Shares each matched sample bilinearly among the centre samples of its surface around it.
void Warper::splat_onto_centre(Band &band) const {
    const Windows &w = centre_.image.windows;
    const std::size_t channels = centre_.image.channels.size(), width = std::size_t(w.width());
    const std::size_t pixels = width * std::size_t(band.last_row - band.first_row + 1);
    band.sums.assign(channels * pixels, 0);
    band.weights.assign(pixels, 0);
    for (const RimSample &s : band.matched) {
        const int left = s.dx < 0 ? s.x - 1 : s.x, top = s.dy < 0 ? s.y - 1 : s.y;
        const double fx = s.dx < 0 ? s.dx + 1.0 : double(s.dx), fy = s.dy < 0 ? s.dy + 1.0 : double(s.dy);
        for (int corner = 0; corner < 4; ++corner) {
            const int x = left + corner % 2, y = top + corner / 2;
            if (y < band.first_row || y > band.last_row || !has_centre(x, y)) continue;
            if (!same_surface(centre_depth(x, y), depth_of(s))) continue;
            const double weight = (corner % 2 ? fx : 1 - fx) * (corner / 2 ? fy : 1 - fy);
            const std::size_t pixel = std::size_t(y - band.first_row) * width + std::size_t(x - w.data.min.x);
            band.weights[pixel] += weight;
            for (std::size_t k = 0; k < channels; ++k)
                band.sums[k * pixels + pixel] += weight * double(value(s, k));
        }
    }
}

void begin_sample(Ldi &out, float z, float dx, float dy, float weight) {
    out.z.push_back(z);
    out.dx.push_back(dx);
    out.dy.push_back(dy);
    out.weight.push_back(weight);
    ++out.begin.back();
}

void Warper::emit_centre(const Band &band, std::size_t pixel, Ldi &out) const {
    const std::size_t first = std::size_t(band.first_row - centre_.image.windows.data.min.y) *
                              std::size_t(centre_.image.windows.width());
    const std::size_t in_band = pixel - first;
    const double extra = band.weights.empty() ? 0 : band.weights[in_band];
    begin_sample(out, centre_.z[pixel], 0, 0, float(1 + extra));
    for (std::size_t k = 0; k < out.channels.size(); ++k) {
        const float own = centre_.image.plane(k)[pixel];
        const bool alone = extra == 0 || out.channels[k].type == PixelType::uint32;
        const double sum = alone ? 0 : band.sums[k * band.weights.size() + in_band];
        out.values[k].push_back(alone ? own : float((double(own) + sum) / (1 + extra)));
    }
}

// One sample for rim samples of one surface in one pixel: the mean in average, the most central one in keep.
void Warper::emit_group(std::span<const RimSample> group, Ldi &out) const {
    const auto off_centre = [](const RimSample &s) { return s.dx * s.dx + s.dy * s.dy; };
    if (options_.merge == Merge::keep) {
        const auto best = std::min_element(group.begin(), group.end(), [&](const RimSample &a, const RimSample &b) {
            return off_centre(a) < off_centre(b);
        });
        group = group.subspan(std::size_t(best - group.begin()), 1);
    }
    const double count = double(group.size());
    double dx = 0, dy = 0, inverse_z = 0;
    for (const RimSample &s : group) {
        dx += double(s.dx);
        dy += double(s.dy);
        inverse_z += double(s.inverse_z);
    }
    const float z = group.size() == 1 ? views_[group[0].view]->z[group[0].source] : float(count / inverse_z);
    begin_sample(out, z, float(dx / count), float(dy / count), float(count));
    for (std::size_t k = 0; k < out.channels.size(); ++k) {
        double sum = 0;
        for (const RimSample &s : group) sum += double(value(s, k));
        const bool alone = group.size() == 1 || out.channels[k].type == PixelType::uint32;
        out.values[k].push_back(alone ? value(group[0], k) : float(sum / count));
    }
}

void Warper::emit_pixel(const Band &band, int x, int y, std::span<const RimSample> extras, Ldi &out) const {
    bool centre_waits = has_centre(x, y);
    const auto emit_waiting_centre = [&](double before) {
        if (!centre_waits || !(centre_depth(x, y) > before)) return;
        emit_centre(band, index(x, y), out);
        centre_waits = false;
    };
    for (std::size_t first = 0, last = 0; first < extras.size(); first = last) {
        while (last < extras.size() && same_surface(depth_of(extras[first]), depth_of(extras[last]))) ++last;
        if (last == first) ++last; // depths beyond what doubles can tell apart
        emit_waiting_centre(depth_of(extras[first]));
        emit_group(extras.subspan(first, last - first), out);
    }
    emit_waiting_centre(-1);
}

Ldi Warper::warp_band(int first_row, int last_row) const {
    Band band{first_row, last_row, {}, {}, {}, {}};
    collect(band);
    if (options_.merge == Merge::average) splat_onto_centre(band);
    Ldi out;
    out.windows = centre_.image.windows;
    out.channels = centre_.image.channels;
    out.values.resize(out.channels.size());
    out.begin.push_back(0);
    const Imath::Box2i &data = out.windows.data;
    std::size_t next = 0;
    for (int y = first_row; y <= last_row; ++y)
        for (int x = data.min.x; x <= data.max.x; ++x) {
            const std::size_t first = next;
            while (next < band.extras.size() && band.extras[next].x == x && band.extras[next].y == y) ++next;
            out.begin.push_back(out.begin.back());
            emit_pixel(band, x, y, std::span(band.extras).subspan(first, next - first), out);
        }
    return out;
}

Ldi Warper::run(Progress &progress) const {
    const Imath::Box2i &data = centre_.image.windows.data;
    const std::size_t bands = std::size_t(centre_.image.windows.height() + band_rows - 1) / band_rows;
    std::vector<Ldi> pieces(bands);
    progress.start("warping", bands);
    parallel_for(bands, [&](std::size_t band) {
        const int first_row = data.min.y + int(band) * band_rows;
        pieces[band] = warp_band(first_row, std::min(first_row + band_rows - 1, data.max.y));
        progress.advance();
    });
    Ldi like;
    like.windows = centre_.image.windows;
    like.channels = centre_.image.channels;
    return concatenate(like, pieces);
}

} // namespace

Ldi warp(std::span<const View> views, const WarpOptions &options, Progress &progress) {
    return Warper(views, options).run(progress);
}

} // namespace sparselens
