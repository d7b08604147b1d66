#include "options/warp_options.h"

#include "harness/tool.h"

#include <CLI/CLI.hpp>

#include <map>

namespace sparselens {

void add_view_list(CLI::App &app, ViewList &list) {
    app.add_option("views", list.files,
                   "Centre view, then views with their camera in the metadata: flat pictures with depth, or "
                   "deep ones; - for a flat one from standard input")
        ->type_name("CENTER.exr [VIEW.exr ...]")
        ->required();
    app.add_option("--view", list.placed,
                   "View whose camera stood X right and Y up of the centre, in scene units")
        ->type_name("X,Y VIEW.exr")
        ->allow_extra_args(false);
}

void add_warp_options(CLI::App &app, WarpCommand &options) {
    add_view_list(app, options.views);
    app.add_option("-o,--output", options.output, "LDI to write; - for standard output")
        ->type_name("LDI.exr")
        ->required()
        ->check(output_name(OutputKind::exr));
    app.add_option("--denoised", options.denoised,
                   "Denoised version of each view, in the same order. Its colours replace the view's, except "
                   "for details that all views show: lamps, glints, strands, texture")
        ->type_name("CENTER.exr [VIEW.exr ...]");
    app.add_option("--noisy", options.noisy,
                   "Layer with the noisy colours, if the views are denoised (Cycles: Noisy Image)")
        ->type_name("LAYER")
        ->excludes("--denoised");
    const std::map<std::string, Merge> merges{{"average", Merge::average}, {"keep", Merge::keep}};
    app.add_option("--merge", options.warp.merge,
                   "How to merge views. average: average the samples of a surface; keep: keep one sample of "
                   "each surface, and the centre view unchanged (default: average)")
        ->type_name("average|keep")
        ->transform(words(merges));
    const std::map<std::string, bool> silhouettes{{"split", true}, {"whole", false}};
    app.add_option("--silhouettes", options.warp.split_silhouettes,
                   "Pixels that mix two surfaces, with --merge average. split: divide them into two samples; "
                   "whole: keep them (default: split)")
        ->type_name("split|whole")
        ->transform(words(silhouettes));
    const std::map<std::string, bool> agreement{{"test", true}, {"assume", false}};
    app.add_option("--agreement", options.warp.test_photo_consistency,
                   "Views that differ, as on mirrors and glass, with --merge average. test: average only "
                   "views that agree within noise or near focus; assume: average all (default: test)")
        ->type_name("test|assume")
        ->transform(words(agreement));
    const std::map<std::string, bool> on_off{{"on", true}, {"off", false}};
    app.add_option("--optical", options.warp.find_images,
                   "Images in mirrors and glass, with --agreement test. on: estimate their depth, and blur "
                   "them by it; off: blur them by the depth of the surface (default: on)")
        ->type_name("on|off")
        ->transform(words(on_off));
    add_device_option(app, options.device, "Device for the warp");
    add_compression_option(app, options.compression, true);
    add_parameters(app, lens_parameters(), options.lens);
    add_camera_options(app, options.camera);
    add_subpixels_option(app, options.supersample);
    add_depth_options(app, options.depth);
    add_parameters(app, kind_parameters(), options.depth.picture);
    add_depth_files_option(app, options.depth_files);
    add_parameters(app, input_colour_parameters(), options.colour.emplace());
    add_history_option(app, options.history);
    add_examples(
        app, {{"Warp views with their camera in the metadata", "ldi-warp center.exr view_*.exr -o ldi.exr"},
              {"Warp views without camera and lens in their metadata",
               "ldi-warp center.exr --view 0.06,0 right.exr --view -0.06,0 left.exr -o ldi.exr "
               "--focal-length 36 --sensor-width 36 --lens-radius 0.06 --focus-distance 5"},
              {"Warp views of cameras that ldi-plan wrote as USD",
               "ldi-warp --camera views.usda center.exr view_*.exr -o ldi.exr"},
              {"Warp noisy views, with their denoised versions",
               "ldi-warp center.exr view_*.exr --denoised smooth.center.exr smooth.view_*.exr -o ldi.exr"},
              {"Warp, cluster and gather in a pipe",
               "ldi-warp center.exr view_*.exr -o - | ldi-cluster - -o - | dof-gather - -o picture.exr"}});
}

void add_camera_options(CLI::App &app, CameraRequest &camera) {
    CLI::Option *file =
        app.add_option("--camera", camera.file,
                       "USD stage or JSON with position, frustum, focus and f-stop of the cameras, instead "
                       "of the metadata of the views; a view takes the camera of its name (view_0.exr: "
                       "view_0). USD needs usd-core in python3, or in the Python of $SPARSELENS_USD_PYTHON")
            ->type_name("SHOT.usd|SHOT.json")
            ->group("Lens");
    app.add_option("--camera-name", camera.name,
                   "Camera of the centre view: its path or its name (default: the only one, or center)")
        ->type_name("NAME")
        ->needs(file)
        ->group("Lens");
    app.add_option("--camera-frame", camera.frame,
                   "Time code at which to read the camera (default: the number of the frame)")
        ->type_name("N")
        ->needs(file)
        ->group("Lens");
}

} // namespace sparselens
