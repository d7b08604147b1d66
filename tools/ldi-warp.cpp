// Views to LDI: ldi-warp [lens options] CENTER.exr [VIEW.exr ...] [--view X,Y VIEW.exr]... -o LDI.exr
#include "base/error.h"
#include "common/pictures.h"
#include "common/tool.h"
#include "common/view_list.h"
#include "common/words.h"
#include "io/camera_metadata.h"
#include "ldi/warp.h"

#include <algorithm>
#include <cmath>

using namespace sparselens;

namespace {

struct Options {
    LensOptions lens;
    DepthOptions depth;
    ViewList views;
    Merge merge = Merge::average;
    bool split_silhouettes = true;
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
    add_lens_options(app, options.lens);
    add_depth_options(app, options.depth);
}

// Perceptive depth is measured at the lens if that is known, else at the outermost view.
WarpOptions warp_options(const Options &options, const LoadedViews &loaded) {
    WarpOptions warp{.merge = options.merge, .split_silhouettes = options.split_silhouettes};
    if (loaded.views.size() == 1) return warp;
    warp.focal_px = resolve_focal_px(loaded.camera, loaded.views[0].image.windows);
    warp.radius = lens_radius_of(loaded.camera).value_or(0);
    for (const View &view : loaded.views) warp.radius = std::max(warp.radius, view.position.length());
    return warp;
}

void run(const Options &options, const ToolContext &tool) {
    LoadedViews loaded = load_views(options.views, options.lens, options.depth);
    for (std::size_t i = 0; i < loaded.views.size(); ++i)
        warn_of_bad_values(tool, loaded.views[i].name, loaded.bad[i]);
    const WarpOptions warp_by = warp_options(options, loaded);
    write_camera(loaded.header, loaded.camera);
    write_picture_window(loaded.header, loaded.views[0].image.windows.data);
    const Ldi ldi = warp(loaded.views, warp_by, *tool.progress);
    tool.say(std::to_string(loaded.views.size()) + " views, " + std::to_string(ldi.samples()) +
             " samples in " + std::to_string(ldi.windows.pixels()) + " pixels");
    warn_of_clamped(tool, options.output, write_ldi(options.output, ldi, loaded.header));
}

} // namespace

int main(int argc, char **argv) {
    CLI::App app("Warps a centre view and views from the rim of the lens into one layered depth image",
                 "ldi-warp");
    Options options;
    add_options(app, options);
    return run_tool(app, argc, argv, [&](const ToolContext &tool) { run(options, tool); });
}
