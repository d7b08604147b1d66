// ldi-plan: plans which views from the rim of the lens, and which of their pixels, are worth rendering.
#include "base/error.h"
#include "chain/notices.h"
#include "chain/plan_views.h"
#include "harness/commands/file_arguments.h"
#include "harness/tool.h"
#include "io/moment_files.h"
#include "io/plan_file.h"
#include "options/plan_options.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

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
    if (division.noise > 0)
        fmt::print(out, "one render of all of them through the lens: about {:.0f} dB{}\n",
                   -10 * std::log10(division.noise), division.alone ? ", better than with views" : "");
}

void say(const std::optional<MomentsNeed> &need, std::FILE *out) {
    if (!need)
        fmt::print(out,
                   "moments of the shutter: these pictures have no texture that tells how far things move\n");
    else if (need->moments == 1)
        fmt::print(out, "things move by {:.1f} pixels while the shutter is open: one moment is enough\n",
                   need->motion);
    else
        fmt::print(out,
                   "things move by up to {:.1f} pixels while the shutter is open: with {} moments, the steps "
                   "between them do not show\n",
                   need->motion, need->moments);
}

Stats plan_stats(const Plan &plan, int views_allowed, const PlanSetting &setting) {
    std::size_t asked = 0;
    for (const PlannedView &view : plan.views) asked += view.mask.count();
    Stats stats{{"views", plan.views.size()},
                {"views_left_out", std::size_t(views_allowed) - plan.views.size()},
                {"pixels", asked},
                {"pixels_left_out", std::size_t(views_allowed) * setting.windows.pixels() - asked}};
    if (setting.moments) {
        stats["moments"] = setting.moments->moments;
        stats["motion"] = setting.moments->motion;
    }
    return stats;
}

void write_layer(const PlanCommand &options, UsdViews &views) {
    if (options.up_axis) views.up_axis = *options.up_axis;
    write_usd_views(options.cameras, views);
}

// Writes the cameras around a camera of USD.
void write_shot(const PlanCommand &options, const ToolContext &tool, UsdViews &all_frames) {
    if (options.camera.file.empty() || !holds_all_frames(options.cameras))
        throw UsageError(
            "give a centre view, or `camera=SHOT.usd` and `cameras=VIEWS.usd` for cameras alone");
    if (!options.output.empty()) throw UsageError("`output`: a plan needs a centre view");
    ShotRequest request{options.camera, options.lens, options.plan.views, options.size};
    if (!request.camera.frame) request.camera.frame = tool.frame;
    UsdViews views = views_of_shot(request, tool.notify());
    all_frames.frames.merge(views.frames);
    views.frames = all_frames.frames;
    write_layer(options, views);
}

// Writes the cameras of a plan.
void write_planned(const PlanCommand &options, const ToolContext &tool, const PlannedViews &made,
                   const StatedCameras &stated, UsdViews &all_frames) {
    if (!holds_all_frames(options.cameras)) {
        const Camera &camera = made.camera;
        const ThinLens &lens = made.setting.lens;
        return write_cameras(options.cameras,
                             cameras_of(made.plan, camera, lens, made.setting.windows.display_width()),
                             {options.centre, lens, camera.metres_per_unit});
    }
    add_planned(all_frames, made, tool.frame);
    if (all_frames.frames.at(tool.frame.value_or(0)).mirrored)
        warn_once(tool, "mirrored",
                  options.centre + ": the world of its camera is left-handed; " + options.cameras +
                      " has z with the other sign");
    if (stated.file()) {
        all_frames.up_axis = stated.file()->up_axis;
        all_frames.frames_per_second = stated.file()->frames_per_second;
        all_frames.stage = stage_of(options.camera);
        all_frames.camera = stated.centre(options.centre)->path;
    }
    write_layer(options, all_frames);
}

// The same options for the centre view of a moment.
PlanCommand for_moment(PlanCommand options, const std::string &moment) {
    for (std::string *name : {&options.centre, &options.depth.picture.depth_file})
        *name = at_moment(*name, moment);
    return options;
}

OpenedView open_centre(const PlanCommand &options, const StatedCameras &stated) {
    const std::optional<FilmCamera> film = stated.of_centre(options.centre);
    OpenedView centre = open_view(options.centre, {options.lens, options.depth, film});
    for (const std::string &warning : stated_warnings(film, options.lens)) centre.warnings.push_back(warning);
    return centre;
}

// `all_frames`: the cameras of the frames before, which one layer of USD holds.
void run(const PlanCommand &asked_for, const ToolContext &tool, UsdViews &all_frames) {
    const bool several = names_moments(asked_for.centre);
    const auto moments = several ? moments_on_disk(asked_for.centre) : std::vector<std::string>{};
    const PlanCommand options = several ? for_moment(asked_for, moments[moments.size() / 2]) : asked_for;
    if (options.centre.empty()) return write_shot(options, tool, all_frames);
    if (options.output.empty())
        throw UsageError("`output` is required: the plan to write, or - for standard output");
    CameraRequest asked = options.camera;
    if (!asked.frame) asked.frame = tool.frame;
    const StatedCameras stated(asked);
    const OpenedView centre = open_centre(options, stated);
    notify_reading(tool.notify(), options.centre, centre.notes, centre.warnings);
    notify_invalid_values(tool.notify(), options.centre, centre.bad);
    PlannedViews made = plan_views(centre, options.plan, options.lens, options.supersample, options.rays,
                                   *tool.progress, tool.notify());
    made.setting.centre = options.centre;
    if (moments.size() > 1)
        made.setting.moments = plan_moments(open_centre(for_moment(asked_for, moments.front()), stated),
                                            open_centre(for_moment(asked_for, moments.back()), stated),
                                            moments.size(), made, options.lens);
    const auto &[plan, setting, camera] = made;
    write_plan(options.output, plan, setting, options.masks);
    if (!options.cameras.empty()) write_planned(options, tool, made, stated, all_frames);
    write_stats(tool, plan_stats(plan, options.plan.views, setting));
    std::FILE *const out = options.output == "-" ? stderr : stdout;
    summarise(plan, centre.view, out);
    if (setting.division) say(*setting.division, out);
    if (moments.size() > 1) say(setting.moments, out);
}

} // namespace

int main(int argc, char **argv) {
    UsdViews all_frames;
    return run_frames(
        "ldi-plan",
        "Plans which views from the rim of the lens, and which of their pixels, are worth rendering", argc,
        argv, [&](CLI::App &app) {
            const auto options = std::make_shared<PlanCommand>();
            add_plan_options(app, *options);
            return Job{
                .work = [options, &all_frames](const ToolContext &tool) { run(*options, tool, all_frames); },
                .joins_moments = true};
        });
}
