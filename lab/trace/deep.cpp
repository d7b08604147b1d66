#include "lab/trace/deep.h"

#include "deep/build.h"
#include "lab/trace/sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens::lab {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Ldi empty_ldi(const RenderSettings &settings) {
    Ldi ldi;
    ldi.windows = settings.windows;
    ldi.channels = rgba_channels();
    ldi.values.resize(4);
    return ldi;
}

// Appends premultiplied colour and alpha as the last sample of the last pixel.
void append(Ldi &ldi, bool volumes, double z, double z_back, const Imath::V4d &rgba) {
    ldi.z.push_back(float(z));
    if (volumes) ldi.z_back.push_back(float(z_back));
    for (int channel = 0; channel < 4; ++channel)
        ldi.values[std::size_t(channel)].push_back(float(rgba[channel]));
    ++ldi.begin.back();
}

void append_slabs(Ldi &ldi, std::span<const Slab> slabs) {
    for (const Slab &slab : slabs) {
        const double alpha = 1 - transmittance({&slab, 1}, slab.z_front, slab.z_back);
        const Imath::V4d whole(slab.colour.x, slab.colour.y, slab.colour.z, 1);
        append(ldi, true, slab.z_front, slab.z_back, alpha * whole);
    }
}

Imath::V4d premultiplied(const Imath::C4f &surface) {
    return double(surface.a) * Imath::V4d(surface.r, surface.g, surface.b, 1);
}

// The rays of one pixel: everything along the ray through its centre, and along each sample's ray.
class PixelRays {
public:
    PixelRays(const Tracer &tracer, const RenderSettings &settings, const Imath::V2d &u,
              const PixelSamples &samples, Imath::V2i pixel)
        : tracer_(tracer), settings_(settings), u_(u), pixel_(pixel), in_pixel_(std::size_t(samples.count())),
          on_light_(in_pixel_.size()) {
        samples.in_pixel(pixel.x, pixel.y, 0, in_pixel_);
        samples.on_light(pixel.x, pixel.y, 0, on_light_);
    }
    std::size_t count() const { return in_pixel_.size(); }
    void centre(LayerBuffers &out) const { trace({0.5, 0.5}, {0.5, 0.5}, out); }
    void sample(std::size_t i, LayerBuffers &out) const { trace(in_pixel_[i], on_light_[i], out); }

private:
    void trace(const Imath::V2d &p, const Imath::V2d &light, LayerBuffers &out) const {
        trace_layers(tracer_, settings_.light, view_ray(settings_, u_, p + Imath::V2d(pixel_.x, pixel_.y)),
                     light, out);
    }

    const Tracer &tracer_;
    const RenderSettings &settings_;
    Imath::V2d u_; // lens point
    Imath::V2i pixel_;
    std::vector<Imath::V2d> in_pixel_, on_light_;
};

template <typename Fill>
Ldi build(const Tracer &tracer, const RenderSettings &settings, int samples, std::uint32_t stream,
          const char *stage, Progress &progress, const Fill &fill, const Imath::V2d &u = {0, 0}) {
    const Ldi like = empty_ldi(settings);
    const PixelSamples points(samples, true, seeded(settings, stream));
    progress.start(stage, settings.windows.pixels());
    return build_by_pixels(like, [&](std::size_t pixel, Ldi &out) {
        fill(PixelRays(tracer, settings, u, points, settings.windows.pixel(pixel)), out);
        append_slabs(out, tracer.scene().slabs);
        progress.advance();
    });
}

void peel(const PixelRays &rays, std::size_t layers, bool volumes, Ldi &out) {
    LayerBuffers centre, other;
    rays.centre(centre);
    const std::size_t peeled = std::min(layers, centre.hits.size());
    std::vector<Imath::V4d> sums(peeled, Imath::V4d(0));
    std::vector<int> met(peeled, 0);
    for (std::size_t i = 0; i < rays.count(); ++i) {
        rays.sample(i, other);
        for (std::size_t k = 0; k < peeled; ++k)
            for (std::size_t j = 0; j < other.hits.size(); ++j)
                if (other.hits[j].primitive == centre.hits[k].primitive) {
                    sums[k] += premultiplied(other.colours[j]);
                    ++met[k];
                }
    }
    for (std::size_t k = 0; k < peeled; ++k) {
        const Imath::V4d colour = met[k] > 0 ? sums[k] / met[k] : premultiplied(centre.colours[k]);
        if (colour[3] > 0) append(out, volumes, centre.hits[k].t, centre.hits[k].t, colour);
    }
}

// The part of a surface that the samples of a pixel see.
struct Visible {
    int primitive; // -1: the sky
    Imath::V4d sum{0};
    double z_sum = 0; // weighted by coverage
    double z() const { return z_sum / sum[3]; }
};

void add_visible(const LayerBuffers &ray, std::vector<Visible> &found) {
    double passes = 1;
    for (std::size_t i = 0; i < ray.hits.size() && passes > 0; ++i) {
        const Imath::V4d seen = passes * premultiplied(ray.colours[i]);
        passes -= seen[3];
        if (seen[3] <= 0) continue;
        const int primitive = ray.hits[i].primitive;
        auto surface = std::ranges::find(found, primitive, &Visible::primitive);
        if (surface == found.end()) surface = found.insert(found.end(), Visible{primitive});
        surface->sum += seen;
        surface->z_sum += seen[3] * ray.hits[i].t;
    }
}

void see(const PixelRays &rays, bool volumes, Ldi &out) {
    LayerBuffers buffers;
    std::vector<Visible> found;
    for (std::size_t i = 0; i < rays.count(); ++i) {
        rays.sample(i, buffers);
        add_visible(buffers, found);
    }
    std::ranges::sort(found, {}, &Visible::z);
    double left = double(rays.count()); // samples that nearer surfaces do not cover
    for (const Visible &surface : found) {
        const double coverage = std::min(1.0, surface.sum[3] / left);
        append(out, volumes, surface.z(), surface.z(), coverage / surface.sum[3] * surface.sum);
        left -= surface.sum[3];
        if (left <= 0) break;
    }
}

struct Stratum {
    Imath::V4d sum{0};
    double z = -1; // -1: nothing met yet
};

// Keeps only the layers that a ray meets in each stratum.
void add_strata(std::span<const Layer> layers, double nearest, std::vector<Stratum> &strata) {
    const double count = double(strata.size());
    const auto stratum_of = [&](const Layer &layer) {
        return std::size_t(std::clamp(count * (1 - nearest / layer.z), 0.0, count - 1));
    };
    for (std::size_t first = 0, last; first < layers.size(); first = last) {
        const std::size_t k = stratum_of(layers[first]);
        for (last = first; last < layers.size() && stratum_of(layers[last]) == k;) ++last;
        const Imath::C4f c = composite(layers.subspan(first, last - first), {});
        strata[k].sum += Imath::V4d(c.r, c.g, c.b, c.a);
        if (strata[k].z < 0) strata[k].z = layers[first].z;
    }
}

void cut(const PixelRays &rays, std::size_t count, double nearest, bool volumes, Ldi &out) {
    LayerBuffers buffers;
    std::vector<Stratum> strata(count);
    rays.centre(buffers);
    add_strata(buffers.layers, nearest, strata); // only for its depths
    for (Stratum &stratum : strata) stratum.sum = Imath::V4d(0);
    for (std::size_t i = 0; i < rays.count(); ++i) {
        rays.sample(i, buffers);
        add_strata(buffers.layers, nearest, strata);
    }
    for (const Stratum &stratum : strata)
        if (stratum.sum[3] > 0)
            append(out, volumes, stratum.z, stratum.z, stratum.sum / double(rays.count()));
}

// Depth of the nearest surface at a pixel centre, seen from the lens centre; arbitrary if only sky is visible.
double nearest_depth(const Tracer &tracer, const RenderSettings &settings) {
    double nearest = infinity;
    for (std::size_t pixel = 0; pixel < settings.windows.pixels(); ++pixel) {
        const Imath::V2i p = settings.windows.pixel(pixel);
        const Ray ray = view_ray(settings, {0, 0}, {p.x + 0.5, p.y + 0.5});
        Hit hit;
        tracer.nearest({&ray, 1}, {&hit, 1});
        nearest = std::min(nearest, hit.t);
    }
    return std::isinf(nearest) ? 1 : nearest;
}

} // namespace

Ldi render_peeled(const Tracer &tracer, const RenderSettings &settings, int layers, int samples,
                  std::uint32_t stream, Progress &progress) {
    const bool volumes = !tracer.scene().slabs.empty();
    return build(tracer, settings, samples, stream, "peel", progress,
                 [&](const PixelRays &rays, Ldi &out) { peel(rays, std::size_t(layers), volumes, out); });
}

Ldi render_visible(const Tracer &tracer, const RenderSettings &settings, int samples, std::uint32_t stream,
                   Progress &progress, const Imath::V2d &u) {
    const bool volumes = !tracer.scene().slabs.empty();
    return build(
        tracer, settings, samples, stream, "visible", progress,
        [&](const PixelRays &rays, Ldi &out) { see(rays, volumes, out); }, u);
}

Ldi render_strata(const Tracer &tracer, const RenderSettings &settings, int strata, int samples,
                  std::uint32_t stream, Progress &progress) {
    const bool volumes = !tracer.scene().slabs.empty();
    const double nearest = nearest_depth(tracer, settings);
    return build(tracer, settings, samples, stream, "strata", progress, [&](const PixelRays &rays, Ldi &out) {
        cut(rays, std::size_t(strata), nearest, volumes, out);
    });
}

} // namespace sparselens::lab
