// ldi-warp: warps a centre view and views from the rim of the lens into one layered depth image.
#include "base/error.h"
#include "harness/stats.h"
#include "harness/tool.h"
#include "io/camera/camera_write.h"
#include "loading/pictures.h"
#include "options/colour_options.h"
#include "options/warp_options.h"
#include "view/view_mapping.h"
#include "warp/pose_check.h"
#include "warp/warp.h"

#include <fmt/format.h>

#include <span>

using namespace sparselens;

namespace {

// Warns of views whose stated position is wrong: they make an LDI with ghosts.
void warn_of_wrong_pose(const ToolContext &tool, std::span<const View> views, double focal_px) {
    const auto text = [](const Imath::V2d &p) {
        return fmt::format("{:g},{:g}", p.x + 0.0, p.y + 0.0);
    }; // no -0
    for (const View &view : views.subspan(1))
        if (const auto better = better_position(views[0], view, focal_px))
            warn(tool,
                 fmt::format(
                     "{}: disagrees with the centre view at its stated position {}; it would agree at {}",
                     view.name, text(view.position), text(*better)));
}

// Reports views whose framing differs from that of the centre view: a frustum that is misread makes ghosts, too.
void say_framings(const ToolContext &tool, std::span<const View> views) {
    for (const View &view : views.subspan(1)) {
        const Framing &centre = views[0].framing, &own = view.framing;
        if (own == Framing{.principal_point = centre.principal_point}) continue;
        const Imath::V2d axis = in_pixels(own.principal_point, view.image.windows) -
                                in_pixels(centre.principal_point, view.image.windows);
        tool.say(fmt::format(
            "{}: optical axis {:g},{:g} pixels from that of the centre view, focal length {:g} times "
            "that of the centre view, {:g} scene units in front of it",
            view.name, axis.x, axis.y, own.zoom, own.forward));
    }
}

void run(const WarpCommand &options, const ToolContext &tool) {
    LoadedViews loaded = load_views(options.views, options.lens, options.depth);
    say_camera(tool, loaded.views[0].name, loaded.camera);
    say_framings(tool, loaded.views);
    for (std::size_t i = 0; i < loaded.views.size(); ++i)
        warn_of_invalid_values(tool, loaded.views[i].name, loaded.bad[i]);
    for (View &view : loaded.views) to_scene_linear(tool, options.colour, view.name, loaded.header, view);
    const WarpOptions warp_by = warp_options(options, loaded);
    write_camera(loaded.header, loaded.camera);
    append_history(loaded.header, tool, options.history);
    write_picture_window(loaded.header, loaded.views[0].image.windows.data);
    const Ldi ldi = warp(loaded.views, warp_by, *tool.progress);
    warn_of_wrong_pose(tool, loaded.views, warp_by.focal_px);
    tool.say(fmt::format("{} views, {} samples in {} pixels", loaded.views.size(), ldi.samples(),
                         ldi.windows.pixels()));
    warn_of_clamped(tool, options.output, write_ldi(options.output, ldi, loaded.header));
    write_stats(tool, warp_stats(loaded.views, ldi));
}

} // namespace

int main(int argc, char **argv) {
    return run_frames(
        "ldi-warp",
        "Warps a centre view and views from the rim of the lens into one layered depth image (LDI)", argc,
        argv, [&](CLI::App &app) {
            const auto options = std::make_shared<WarpCommand>();
            add_warp_options(app, *options);
            return [options](const ToolContext &tool) { run(*options, tool); };
        });
}
