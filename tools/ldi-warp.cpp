// Views to LDI: ldi-warp [lens options] CENTER.exr [VIEW.exr ...] [--view X,Y VIEW.exr]... -o LDI.exr
#include "base/error.h"
#include "common/colour_options.h"
#include "common/pictures.h"
#include "common/stats.h"
#include "common/tool.h"
#include "common/view_list.h"
#include "common/words.h"
#include "io/camera_metadata.h"
#include "ldi/misplaced_view.h"
#include "ldi/warp.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>

using namespace sparselens;

namespace {

struct Options {
    LensOptions lens;
    DepthOptions depth;
    ColourOptions colour;
    ViewList views;
    Merge merge = Merge::average;
    bool split_silhouettes = true, test_agreement = true;
    std::string output;
};

void add_options(CLI::App &app, Options &options) {
    add_view_list(app, options.views);
    app.add_option("-o,--output", options.output, "LDI to write, - for standard output")
        ->type_name("LDI.exr")
        ->required();
    const std::map<std::string, Merge> merges{{"average", Merge::average}, {"keep", Merge::keep}};
    app.add_option("--merge", options.merge,
                   "average: views of one surface are averaged; keep: one sample a surface, the centre view "
                   "unchanged")
        ->type_name("average|keep")
        ->transform(words(merges));
    const std::map<std::string, bool> silhouettes{{"split", true}, {"whole", false}};
    app.add_option("--silhouettes", options.split_silhouettes,
                   "split: pixels that mix two surfaces become two samples (average); whole: they stay one")
        ->type_name("split|whole")
        ->transform(words(silhouettes));
    const std::map<std::string, bool> agreement{{"test", true}, {"assume", false}};
    app.add_option("--agreement", options.test_agreement,
                   "test: out of focus, views that disagree beyond noise (mirrors, glass) are not averaged; "
                   "assume: all are")
        ->type_name("test|assume")
        ->transform(words(agreement));
    add_lens_options(app, options.lens);
    add_depth_options(app, options.depth);
    add_input_colour_options(app, options.colour);
}

// Perceptive depth is measured at the lens if that is known, else at the outermost view.
WarpOptions warp_options(const Options &options, const LoadedViews &loaded) {
    WarpOptions warp{.merge = options.merge,
                     .split_silhouettes = options.split_silhouettes,
                     .test_agreement = options.test_agreement,
                     .focus = loaded.camera.focus_distance};
    if (loaded.views.size() == 1) return warp;
    warp.focal_px = resolve_focal_px(loaded.camera, loaded.views[0].image.windows);
    warp.radius = lens_radius_of(loaded.camera).value_or(0);
    for (const View &view : loaded.views) warp.radius = std::max(warp.radius, view.position.length());
    return warp;
}

// A view that is not where it is said to be makes an LDI of ghosts.
void warn_of_misplaced(const ToolContext &tool, std::span<const View> views, double focal_px) {
    const auto text = [](const Imath::V2d &p) {
        char both[64];
        std::snprintf(both, sizeof both, "%g,%g", p.x + 0.0, p.y + 0.0); // no -0
        return std::string(both);
    };
    for (const View &view : views.subspan(1))
        if (const auto better = better_position(views[0], view, focal_px))
            warn(tool, view.name + ": disagrees with the centre view where it is said to stand, at " +
                           text(view.position) + "; it would agree at " + text(*better));
}

void run(const Options &options, const ToolContext &tool) {
    LoadedViews loaded = load_views(options.views, options.lens, options.depth);
    say_camera(tool, loaded.views[0].name, loaded.camera);
    for (std::size_t i = 0; i < loaded.views.size(); ++i)
        warn_of_bad_values(tool, loaded.views[i].name, loaded.bad[i]);
    for (View &view : loaded.views) to_scene_linear(tool, options.colour, view.name, loaded.header, view);
    const WarpOptions warp_by = warp_options(options, loaded);
    write_camera(loaded.header, loaded.camera);
    write_picture_window(loaded.header, loaded.views[0].image.windows.data);
    const Ldi ldi = warp(loaded.views, warp_by, *tool.progress);
    warn_of_misplaced(tool, loaded.views, warp_by.focal_px);
    tool.say(std::to_string(loaded.views.size()) + " views, " + std::to_string(ldi.samples()) +
             " samples in " + std::to_string(ldi.windows.pixels()) + " pixels");
    warn_of_clamped(tool, options.output, write_ldi(options.output, ldi, loaded.header));
    write_stats(tool, warp_stats(loaded.views, ldi));
}

} // namespace

int main(int argc, char **argv) {
    return run_frames("ldi-warp",
                      "Warps a centre view and views from the rim of the lens into one layered depth image",
                      argc, argv, [&](CLI::App &app) {
                          const auto options = std::make_shared<Options>();
                          add_options(app, *options);
                          return [options](const ToolContext &tool) { run(*options, tool); };
                      });
}
