#include "lab/tracing/traced_pictures.h"

#include "base/error.h"
#include "io/plan_file.h"
#include "lab/trace/deep.h"
#include "lens/aperture.h"
#include "lens/lens_points.h"
#include "lens/lens_samples.h"

#include <fmt/format.h>

namespace sparselens::lab {

namespace {

// Streams of random numbers; the reference uses stream 0. Each moment of the shutter has streams of its own.
enum Stream : std::uint32_t {
    of_centre = 1,
    next_moment = 0x10000,
    of_deep = 0x1000000,
    of_rim = 0x2000000,
    of_lens = 0x3000000,
    of_halves = 0x3800000
};

void add_view(const TraceJob &job, const RenderSettings &settings, int samples, const std::string &name,
              const Viewpoint &from, std::uint32_t stream) {
    job.outputs.add(name, from,
                    [&] { return render_view(job.tracer, settings, from.u, samples, stream, job.progress); });
}

void add_reference(const TraceJob &job, const RenderSettings &settings, int rays, const std::string &name) {
    job.outputs.add(
        name, {}, [&] { return render_reference(job.tracer, settings, rays, job.progress); }, rays);
}

// Views are averaged with equal weights, so only looks that change the aperture's shape appear.
std::vector<Imath::V2d> lens_view_points(const LensLooks &looks, int n) {
    const Aperture aperture(looks.aperture);
    const LensLooks shape_alone{.aperture = looks.aperture, .axis = looks.axis};
    if (n > 0 && (looks != shape_alone || aperture.two_sided() || aperture.coloured()))
        throw UsageError("--lens-views shows blades, squeeze and grey pictures of the aperture only: leave "
                         "out other looks");
    std::vector<Imath::V2d> points = spiral_lens_points(n);
    if (looks.aperture == ApertureShape() || n == 0) return points;
    const std::vector<LensSample> samples = lens_samples(aperture, std::size_t(n), 1);
    for (std::size_t k = 0; k < points.size(); ++k)
        points[k] = Imath::V2d(double(samples[k].x), -double(samples[k].y));
    return points;
}

} // namespace

std::vector<Imath::V2d> trace_plan(const TraceJob &job) {
    const PlanRequest plan = read_plan(job.options.plan);
    RenderSettings settings = job.view;
    if (plan.display != settings.windows.display ||
        plan.across.value_or(job.options.supersample) != job.options.supersample)
        throw Error(job.options.plan + ": made for a picture of another size: give the same --size "
                                       "and --supersample as there");
    std::vector<Imath::V2d> points;
    for (std::size_t k = 0; k < plan.views.size(); ++k) {
        const RequestedView &view = plan.views[k];
        settings.windows.data = view.window;
        job.outputs.add(fmt::format("view_{}.exr", k), {view.u}, [&] {
            const PixelMask mask = mask_of(view);
            return render_view(job.tracer, settings, view.u, job.view_samples, of_rim + std::uint32_t(k),
                               job.progress, mask.set);
        });
        points.push_back(view.u);
    }
    return points;
}

namespace {

// The centre view and the rim views, with `ending` in their names.
void add_all(const TraceJob &job, const RenderSettings &settings, const std::vector<Imath::V2d> &rim,
             Viewpoint from, const std::string &ending, std::uint32_t stream) {
    add_view(job, settings, job.view_samples, "center" + ending, from, stream + of_centre);
    for (std::size_t k = 0; k < rim.size(); ++k) {
        from.u = rim[k];
        add_view(job, settings, job.view_samples, fmt::format("view_{}{}", k, ending), from,
                 stream + of_rim + std::uint32_t(k));
    }
}

} // namespace

std::vector<Imath::V2d> trace_rim(const TraceJob &job) {
    const std::vector<Imath::V2d> rim = rim_lens_points(job.options.views);
    const int moments = job.options.moments;
    if (moments == 0) add_all(job, job.view, rim, {}, ".exr", 0);
    for (int moment = 0; moment < moments; ++moment) {
        RenderSettings settings = job.view;
        settings.exposure = moment_of(moment, moments);
        settings.scattered = moments > 1; // on grids, all moments would have the same samples
        add_all(job, settings, rim, {{0, 0}, StatedMoment{moment, moments}}, fmt::format("_{}.exr", moment),
                std::uint32_t(moment) * next_moment);
    }
    return rim;
}

void trace_lens(const TraceJob &job) {
    RenderSettings to_average = job.settings;
    to_average.scattered = true;
    const std::vector<Imath::V2d> points = lens_view_points(job.settings.looks, job.options.lens_views);
    for (std::size_t k = 0; k < points.size(); ++k)
        add_view(job, to_average, job.options.samples, fmt::format("lens_{:04}.exr", k), {points[k]},
                 of_lens + std::uint32_t(k));
}

void trace_reference(const TraceJob &job) {
    if (job.options.reference == 0) return;
    add_reference(job, job.settings, job.options.reference, "reference.exr");
}

void trace_halves(const TraceJob &job) {
    RenderSettings settings = job.settings;
    if (job.options.halves == 0) return;
    for (const int k : {1, 2}) {
        settings.stream = of_halves + std::uint32_t(k);
        add_reference(job, settings, job.options.halves / 2, fmt::format("rays_{}.exr", k));
    }
}

namespace {

void trace_deep_views(const TraceJob &job) {
    const std::vector<Imath::V2d> rim = rim_lens_points(job.options.views);
    for (std::size_t k = 0; k < rim.size(); ++k)
        job.outputs.add_deep(fmt::format("deep_view_{}.exr", k), {rim[k]}, [&] {
            return render_visible(job.tracer, job.view, job.view_samples, of_deep + 1 + std::uint32_t(k),
                                  job.progress, rim[k]);
        });
}

} // namespace

void trace_deep(const TraceJob &job) {
    const int samples = job.view_samples;
    for (const auto &[kind, layers] : job.options.deep) switch (kind) {
        case DeepKind::visible:
            job.outputs.add_deep("deep_visible.exr", {}, [&] {
                return render_visible(job.tracer, job.view, samples, of_deep, job.progress);
            });
            break;
        case DeepKind::views: trace_deep_views(job); break;
        case DeepKind::peel:
            job.outputs.add_deep("deep_peel.exr", {}, [&, layers = layers] {
                return render_peeled(job.tracer, job.view, layers, samples, of_deep, job.progress);
            });
            break;
        case DeepKind::strata:
            job.outputs.add_deep("deep_strata.exr", {}, [&, layers = layers] {
                return render_strata(job.tracer, job.view, layers, samples, of_deep, job.progress);
            });
        }
}

} // namespace sparselens::lab
