// ldi-plan: plans which views from the rim of the lens, and which of their pixels, are worth rendering.
#include "chain/file_notices.h"
#include "chain/plan_views.h"
#include "harness/stats.h"
#include "harness/tool.h"
#include "io/cameras_file.h"
#include "options/plan_options.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

using namespace sparselens;

namespace {

void summarise(const Plan &plan, const View &centre, std::FILE *out) {
    const double pixels = double(centre.image.windows.pixels());
    for (const PlannedView &view : plan.views)
        fmt::print(out, "view at lens point ({:.3f}, {:.3f}): {:.1f} % of a full view, {} pixels uncovered\n",
                   view.u.x, view.u.y, 100 * double(view.mask.count()) / pixels, view.uncovered);
    if (plan.views.empty())
        fmt::print(out, "no further view is worth rendering\n");
    else
        fmt::print(out, "in total {:.2f} of a full view\n", plan.share());
    if (plan.noise > 0)
        fmt::print(
            out, "noise left in the lens picture of this view: {:.1f} dB; further samples are worth it {}\n",
            -10 * std::log10(plan.noise),
            plan.full_views ? "everywhere: full views"
                            : fmt::format("in {:.1f} % of it", 100 * double(plan.noisy) / pixels));
    if (plan.supersample > 1)
        fmt::print(
            out,
            "edges of depth in {:.1f} % of it: render views {} times as large with 1/{} of the samples "
            "(--supersample)\n",
            100 * plan.edges, plan.supersample, plan.supersample * plan.supersample);
    const OverscanNeed &o = plan.overscan;
    fmt::print(out, "overscan that the lens needs, in pixels: left {}, top {}, right {}, bottom {}\n", o.left,
               o.top, o.right, o.bottom);
}

void say(const RayDivision &division, std::FILE *out) {
    fmt::print(out, "rays per pixel of the picture: {} for {} views{} (samples per pixel of a view: {})\n",
               division.of_views(), division.views,
               division.supersample > 1 ? fmt::format(" {} times as large", division.supersample) : "",
               division.samples);
    if (division.per_render > 0)
        fmt::print(out, "... and {} for each of two renders through the lens, for dof-finish\n",
                   division.per_render);
}

Stats plan_stats(const Plan &plan, int views_allowed, const Windows &centre) {
    std::size_t asked = 0;
    for (const PlannedView &view : plan.views) asked += view.mask.count();
    return {{"views", plan.views.size()},
            {"views_left_out", std::size_t(views_allowed) - plan.views.size()},
            {"pixels", asked},
            {"pixels_left_out", std::size_t(views_allowed) * centre.pixels() - asked}};
}

void run(const PlanCommand &options, const ToolContext &tool) {
    const OpenedView centre = open_view(options.centre, {options.lens, options.depth});
    tell_reading(tool.tell(), options.centre, centre.notes, centre.warnings);
    tell_invalid_values(tool.tell(), options.centre, centre.bad);
    PlannedViews made = plan_views(centre, options.plan, options.lens, options.supersample, options.rays,
                                   *tool.progress, tool.tell());
    made.setting.centre = options.centre;
    const auto &[plan, setting, camera] = made;
    write_plan(options.output, plan, setting, options.masks);
    const Windows &windows = setting.windows;
    if (!options.cameras.empty())
        write_cameras(options.cameras, cameras_of(plan, camera, setting.lens, windows.display_width()),
                      {options.centre, setting.lens, camera.metres_per_unit});
    write_stats(tool, plan_stats(plan, options.plan.views, windows));
    std::FILE *const out = options.output == "-" ? stderr : stdout;
    summarise(plan, centre.view, out);
    if (setting.division) say(*setting.division, out);
}

} // namespace

int main(int argc, char **argv) {
    return run_frames(
        "ldi-plan",
        "Plans which views from the rim of the lens, and which of their pixels, are worth rendering", argc,
        argv, [&](CLI::App &app) {
            const auto options = std::make_shared<PlanCommand>();
            add_plan_options(app, *options);
            return Job{[options](const ToolContext &tool) { run(*options, tool); }};
        });
}
