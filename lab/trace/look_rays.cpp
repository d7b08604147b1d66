#include "lab/trace/look_rays.h"

#include "base/parallel.h"
#include "lab/trace/sampling.h"

#include <algorithm>

namespace sparselens::lab {

namespace {

constexpr std::size_t batch_size = 64;

// The sums of one pixel: R, G, B, A.
struct PixelSums {
    std::array<double, 4> light{}, weight{};
};

// The rays of one pixel, and what they see.
struct Batch {
    std::array<Imath::V2d, batch_size> in_pixel, on_lens, on_light{};
    std::array<LensPoint, batch_size> points;
    std::array<Ray, batch_size> rays;
    std::array<Imath::C4f, batch_size> radiance;
    std::array<double, batch_size> time, depth, inverse_focus;
    std::array<bool, batch_size> passes;
};

double of(const Imath::C4f &colour, std::size_t channel) {
    const std::array<float, 4> values{colour.r, colour.g, colour.b, colour.a};
    return double(values[channel]);
}

class LookPicture {
public:
    LookPicture(const Tracer &tracer, const RenderSettings &settings, int samples)
        : tracer_(tracer), settings_(settings), points_(samples, false, seeded(settings, settings.stream)),
          rays_(settings) {}

    PixelSums pixel(int x, int y) const {
        PixelSums sums;
        const std::size_t samples = std::size_t(points_.count());
        for (std::size_t first = 0; first < samples; first += batch_size) {
            const std::size_t n = std::min(batch_size, samples - first);
            Batch batch = make_batch(x, y, std::uint32_t(first), n);
            if (rays_.one_ray()) {
                trace(batch, 1, n);
                for (std::size_t k = 0; k < 4; ++k) add(sums, batch, k, n);
                continue;
            }
            for (std::size_t colour = 0; colour < 3; ++colour) {
                trace(batch, colour, n);
                add(sums, batch, colour, n);
                if (colour == 1) add(sums, batch, 3, n); // coverage is taken from green
            }
        }
        return sums;
    }

private:
    Batch make_batch(int x, int y, std::uint32_t first, std::size_t n) const {
        Batch batch;
        points_.in_pixel(x, y, first, std::span(batch.in_pixel).first(n));
        points_.on_lens(x, y, first, std::span(batch.on_lens).first(n));
        points_.in_time(exposure_of_row(settings_, y), x, y, first, std::span(batch.time).first(n));
        if (settings_.light == Light::area) points_.on_light(x, y, first, std::span(batch.on_light).first(n));
        for (std::size_t i = 0; i < n; ++i) {
            batch.in_pixel[i] += Imath::V2d(x, y);
            batch.points[i] = rays_.lens_point(batch.on_lens[i]);
            batch.passes[i] = rays_.passes(batch.points[i], batch.in_pixel[i]);
        }
        return batch;
    }

    void trace(Batch &batch, std::size_t colour, std::size_t n) const {
        for (std::size_t i = 0; i < n; ++i) {
            batch.inverse_focus[i] = rays_.inverse_focus(batch.in_pixel[i], colour);
            batch.rays[i] =
                rays_.ray(batch.points[i].u, batch.in_pixel[i], batch.inverse_focus[i], batch.time[i]);
        }
        trace_radiance(tracer_, settings_.light, std::span(batch.rays).first(n),
                       std::span(batch.on_light).first(n), std::span(batch.radiance).first(n));
        for (Imath::C4f &c : std::span(batch.radiance).first(n)) {
            const std::array<double, 3> rgb{double(c.r), double(c.g), double(c.b)};
            const auto factor = float(highlight_factor(settings_.highlights, rgb, double(c.a)));
            c.r *= factor, c.g *= factor, c.b *= factor;
        }
        if (!rays_.two_sided()) return;
        for (std::size_t i = 0; i < n; ++i) batch.depth[i] = visible_depth(tracer_, batch.rays[i]);
    }

    void add(PixelSums &sums, const Batch &batch, std::size_t channel, std::size_t n) const {
        const bool darkens = rays_.darkens();
        for (std::size_t i = 0; i < n; ++i) {
            const LensPoint &point = batch.points[i];
            double weight = channel < 3 ? double(point.rgb[channel]) : 1;
            if (rays_.two_sided()) // coverage counts like green
                weight *= point.side(1 / batch.depth[i] < batch.inverse_focus[i], channel < 3 ? channel : 1);
            if (batch.passes[i]) sums.light[channel] += weight * of(batch.radiance[i], channel);
            if (channel < 3 && darkens)
                sums.weight[channel] += 1; // mean over the whole lens: dark where the cat-eye cuts it off
            else if (batch.passes[i])
                sums.weight[channel] += weight;
        }
    }

    const Tracer &tracer_;
    const RenderSettings &settings_;
    PixelSamples points_;
    LookRays rays_;
};

} // namespace

LookRays::LookRays(const RenderSettings &settings)
    : settings_(settings), looks_(settings.looks), aperture_(looks_.aperture),
      frame_(picture_frame(settings.windows, looks_)), field_(looks_, settings.lens, frame_),
      cat_eye_(aperture_, looks_, frame_) {}

double LookRays::inverse_focus(const Imath::V2d &p, std::size_t colour) const {
    const ThinLens &lens = settings_.lens;
    const double shift = looks_.chromatic_coc[colour];
    // c = R F (1/d - 1/z)
    return field_.factor(without_breathing(p)) / lens.focus +
           (shift == 0 ? 0 : shift / (lens.radius * lens.focal_px));
}

Ray LookRays::ray(const Imath::V2d &u, const Imath::V2d &p, double inverse_focus, double time) const {
    Ray ray = view_ray_at_rest(settings_, u, without_breathing(p), time);
    const Imath::V2d o =
        settings_.lens.radius * u * inverse_focus +
        skewed(field_.skew(without_breathing(p)), u) / (looks_.magnification * settings_.lens.focal_px);
    ray.direction -= Imath::V3d(o.x, o.y, 0);
    return from_camera(settings_, ray);
}

Image render_looks(const Tracer &tracer, const RenderSettings &settings, int samples, Progress &progress) {
    Image image(settings.windows, rgba_channels());
    const LookPicture picture(tracer, settings, samples);
    const Imath::V2i corner = settings.windows.data.min;
    progress.start("reference", std::size_t(settings.windows.height()));
    parallel_for(std::size_t(settings.windows.height()), [&](std::size_t row) {
        for (int x = 0; x < settings.windows.width(); ++x) {
            const PixelSums sums = picture.pixel(corner.x + x, corner.y + int(row));
            for (std::size_t k = 0; k < 4; ++k)
                image.at(k, corner.x + x, corner.y + int(row)) =
                    sums.weight[k] > 0 ? float(sums.light[k] / sums.weight[k]) : 0;
        }
        progress.advance();
    });
    return image;
}

} // namespace sparselens::lab
