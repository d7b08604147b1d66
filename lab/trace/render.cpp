#include "lab/trace/render.h"

#include "base/parallel.h"
#include "lab/trace/look_rays.h"
#include "lab/trace/sampling.h"
#include "lens/lens_points.h"
#include "shutter/shutter_mean.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace sparselens::lab {

namespace {

constexpr std::size_t batch_size = 64;

Imath::V2d direction_through(const RenderSettings &settings, const Imath::V2d &p) {
    const Imath::Box2i &display = settings.windows.display;
    const Imath::V2d centre(0.5 * (display.min.x + display.max.x + 1),
                            0.5 * (display.min.y + display.max.y + 1));
    const double per_pixel = 1 / settings.lens.focal_px;
    return {(p.x - centre.x) * per_pixel, (centre.y - p.y) * per_pixel / settings.lens.pixel_aspect};
}

// Consecutive samples of one pixel.
struct Run {
    int x, y;            // the pixel
    std::uint32_t first; // index of the first sample
    std::span<Ray> rays;
    std::span<Imath::V2d> light_points;
};

// Mean of `samples` rays in the pixels of row y at these columns, counted from the data window. make(Run) fills the
// rays. Batches continue from pixel to pixel, so that a few samples per pixel fill them as well as many.
template <typename Make>
void render_row(const Tracer &tracer, Light light, Image &image, int y, std::span<const int> columns,
                std::size_t samples, const Make &make) {
    const Windows &windows = image.windows;
    const std::size_t total = columns.size() * samples;
    std::array<Ray, batch_size> rays;
    std::array<Imath::V2d, batch_size> light_points{};
    std::array<Imath::C4f, batch_size> radiance;
    std::vector<Imath::Vec4<double>> sums(
        columns.size(), Imath::Vec4<double>(0)); // double: thousands of samples, lamps among them
    for (std::size_t first = 0; first < total; first += batch_size) {
        const std::size_t n = std::min(batch_size, total - first);
        for (std::size_t i = 0; i < n;) {
            const std::size_t at = (first + i) / samples, index = (first + i) % samples;
            const std::size_t count = std::min(n - i, samples - index);
            make(Run{windows.data.min.x + columns[at], y, std::uint32_t(index),
                     std::span(rays).subspan(i, count), std::span(light_points).subspan(i, count)});
            i += count;
        }
        trace_radiance(tracer, light, std::span(rays).first(n), std::span(light_points).first(n),
                       std::span(radiance).first(n));
        for (std::size_t i = 0; i < n; ++i)
            sums[(first + i) / samples] +=
                Imath::Vec4<double>(radiance[i].r, radiance[i].g, radiance[i].b, radiance[i].a);
    }
    const std::size_t row = windows.index(Imath::V2i(windows.data.min.x, y));
    for (std::size_t channel = 0; channel < 4; ++channel)
        for (std::size_t i = 0; i < columns.size(); ++i)
            image.plane(channel)[row + std::size_t(columns[i])] =
                float(sums[i][int(channel)] / double(samples));
}

void depth_row(const Tracer &tracer, const RenderSettings &settings, const Imath::V2d &u, int y,
               std::span<const int> columns, std::span<float> z) {
    std::array<Ray, batch_size> rays;
    std::array<Hit, batch_size> hits;
    for (std::size_t first = 0; first < columns.size(); first += batch_size) {
        const auto some = columns.subspan(first, std::min(batch_size, columns.size() - first));
        for (std::size_t i = 0; i < some.size(); ++i)
            rays[i] = view_ray(settings, u, {settings.windows.data.min.x + some[i] + 0.5, y + 0.5});
        if (tracer.scene().translucent) {
            for (std::size_t i = 0; i < some.size(); ++i)
                z[std::size_t(some[i])] = float(visible_depth(tracer, rays[i]));
            continue;
        }
        tracer.nearest(std::span(rays).first(some.size()), std::span(hits).first(some.size()));
        for (std::size_t i = 0; i < some.size(); ++i) z[std::size_t(some[i])] = float(hits[i].t);
    }
}

std::vector<int> columns_asked(std::span<const std::uint8_t> asked_row, int width) {
    std::vector<int> columns;
    for (int x = 0; x < width; ++x)
        if (asked_row.empty() || asked_row[std::size_t(x)] != 0) columns.push_back(x);
    return columns;
}

} // namespace

Exposure exposure_of_row(const RenderSettings &settings, int y) {
    const Imath::Box2i &display = settings.windows.display;
    const ShutterPart part =
        sparselens::exposure_of_row(y - display.min.y, settings.windows.display_height(), settings.rolling);
    return {settings.exposure.at(part.from), settings.exposure.at(part.to)};
}

Ray from_camera(const RenderSettings &settings, const Ray &at_rest) {
    if (!settings.camera.moves()) return at_rest;
    const Placement camera(settings.camera, at_rest.time);
    return {camera.point(at_rest.origin), camera.direction(at_rest.direction), at_rest.time};
}

Ray view_ray_at_rest(const RenderSettings &settings, const Imath::V2d &u, const Imath::V2d &p, double time) {
    const Imath::V2d d = direction_through(settings, p), o = settings.lens.radius * u;
    return {{o.x, o.y, 0}, {d.x, d.y, 1}, time};
}

Ray view_ray(const RenderSettings &settings, const Imath::V2d &u, const Imath::V2d &p, double time) {
    return from_camera(settings, view_ray_at_rest(settings, u, p, time));
}

Ray lens_ray(const RenderSettings &settings, const Imath::V2d &u, const Imath::V2d &p, double time) {
    const Imath::V2d o = settings.lens.radius * u;
    const Imath::V2d d = direction_through(settings, p) - o / settings.lens.focus;
    return from_camera(settings, {{o.x, o.y, 0}, {d.x, d.y, 1}, time});
}

Image render_view(const Tracer &tracer, const RenderSettings &settings, const Imath::V2d &u, int samples,
                  std::uint32_t stream, Progress &progress, std::span<const std::uint8_t> asked) {
    auto channels = rgba_channels();
    channels.push_back({"Z", PixelType::float32});
    Image image(settings.windows, channels);
    const PixelSamples points(samples, !settings.scattered, seeded(settings, stream));
    const bool scatters = settings.light == Light::area || tracer.scene().mirrors;
    const auto make = [&](const Run &run) {
        std::array<Imath::V2d, batch_size> p;
        std::array<double, batch_size> time;
        points.in_pixel(run.x, run.y, run.first, std::span(p).first(run.rays.size()));
        points.in_time(exposure_of_row(settings, run.y), run.x, run.y, run.first,
                       std::span(time).first(run.rays.size()));
        for (std::size_t i = 0; i < run.rays.size(); ++i)
            run.rays[i] = view_ray(settings, u, p[i] + Imath::V2d(run.x, run.y), time[i]);
        if (scatters) points.on_light(run.x, run.y, run.first, run.light_points);
    };
    const std::size_t width = std::size_t(settings.windows.width());
    std::ranges::fill(image.plane(4), std::numeric_limits<float>::infinity());
    progress.start("view", std::size_t(settings.windows.height()));
    parallel_for(std::size_t(settings.windows.height()), [&](std::size_t row) {
        const int y = settings.windows.data.min.y + int(row);
        const auto columns =
            columns_asked(asked.empty() ? asked : asked.subspan(row * width, width), int(width));
        render_row(tracer, settings.light, image, y, columns, std::size_t(samples), make);
        depth_row(tracer, settings, u, y, columns, image.plane(4).subspan(row * width, width));
        progress.advance();
    });
    return image;
}

Image render_reference(const Tracer &tracer, const RenderSettings &settings, int samples,
                       Progress &progress) {
    if (settings.looks != LensLooks() || settings.highlights.gain != 1)
        return render_looks(tracer, settings, samples, progress);
    Image image(settings.windows, rgba_channels());
    const PixelSamples points(samples, false, seeded(settings, settings.stream));
    const bool scatters = settings.light == Light::area || tracer.scene().mirrors;
    const auto make = [&](const Run &run) {
        std::array<Imath::V2d, batch_size> p, on_lens;
        std::array<double, batch_size> time;
        points.in_pixel(run.x, run.y, run.first, std::span(p).first(run.rays.size()));
        points.on_lens(run.x, run.y, run.first, std::span(on_lens).first(run.rays.size()));
        points.in_time(exposure_of_row(settings, run.y), run.x, run.y, run.first,
                       std::span(time).first(run.rays.size()));
        for (std::size_t i = 0; i < run.rays.size(); ++i)
            run.rays[i] =
                lens_ray(settings, disc_point(on_lens[i]), p[i] + Imath::V2d(run.x, run.y), time[i]);
        if (scatters) points.on_light(run.x, run.y, run.first, run.light_points);
    };
    progress.start("reference", std::size_t(settings.windows.height()));
    parallel_for(std::size_t(settings.windows.height()), [&](std::size_t row) {
        render_row(tracer, settings.light, image, settings.windows.data.min.y + int(row),
                   columns_asked({}, settings.windows.width()), std::size_t(samples), make);
        progress.advance();
    });
    return image;
}

} // namespace sparselens::lab
