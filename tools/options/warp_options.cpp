#include "options/warp_options.h"

#include "harness/examples.h"
#include "harness/words.h"
#include "options/chosen_device.h"
#include "options/picture_options.h"

#include <CLI/CLI.hpp>

#include <map>

namespace sparselens {

void add_warp_options(CLI::App &app, WarpCommand &options) {
    add_view_list(app, options.views);
    app.add_option("-o,--output", options.output, "LDI to write; - for standard output")
        ->type_name("LDI.exr")
        ->required()
        ->check(output_name(OutputKind::exr));
    app.add_option("--denoised", options.denoised,
                   "What a denoiser made of each view, in the order of the views. Its colours are taken but "
                   "for details that "
                   "all views show: lamps, glints, strands, texture")
        ->type_name("CENTER.exr [VIEW.exr ...]");
    app.add_option("--noisy", options.noisy,
                   "The same for views that are denoised and hold what they were before in this layer "
                   "(Cycles: Noisy Image)")
        ->type_name("LAYER")
        ->excludes("--denoised");
    const std::map<std::string, Merge> merges{{"average", Merge::average}, {"keep", Merge::keep}};
    app.add_option("--merge", options.merge,
                   "average: average the views of a surface; keep: keep one sample per surface and leave the "
                   "centre view "
                   "unchanged (default: average)")
        ->type_name("average|keep")
        ->transform(words(merges));
    const std::map<std::string, bool> silhouettes{{"split", true}, {"whole", false}};
    app.add_option("--silhouettes", options.split_silhouettes,
                   "With --merge average, split: pixels that mix two surfaces become two samples; whole: "
                   "they stay one "
                   "(default: split)")
        ->type_name("split|whole")
        ->transform(words(silhouettes));
    const std::map<std::string, bool> agreement{{"test", true}, {"assume", false}};
    app.add_option("--agreement", options.test_photo_consistency,
                   "With --merge average, test: views that disagree out of focus beyond noise (mirrors, "
                   "glass) are not "
                   "averaged; assume: all are averaged (default: test)")
        ->type_name("test|assume")
        ->transform(words(agreement));
    const std::map<std::string, bool> optical{{"on", true}, {"off", false}};
    app.add_option("--optical", options.find_images,
                   "With --agreement test, on: estimate the depth of images in mirrors and glass, and blur "
                   "them by it; "
                   "off: blur them by that of the surface (default: on)")
        ->type_name("on|off")
        ->transform(words(optical));
    const std::map<std::string, bool> precisions{{"exact", false}, {"lens", true}};
    app.add_option("--precision", options.round_for_lens,
                   "lens: round depths and offsets to 1/64 pixel of blur and colours to 1/512 of themselves, "
                   "which makes files a quarter smaller; exact: keep all digits (default: exact)")
        ->type_name("exact|lens")
        ->transform(words(precisions));
    add_device_option(app, options.device, "What warps");
    add_compression_option(app, options.compression, true);
    add_lens_options(app, options.lens);
    add_subpixels_option(app, options.views.supersample);
    add_depth_options(app, options.depth);
    add_depth_files_option(app, options.views.depth_files);
    add_input_colour_options(app, options.colour);
    add_history_option(app, options.history);
    add_examples(
        app, {{"Warp views that say where their cameras stood", "ldi-warp center.exr view_*.exr -o ldi.exr"},
              {"Warp views that do not, of a lens that they do not describe either",
               "ldi-warp center.exr --view 0.06,0 right.exr --view -0.06,0 left.exr -o ldi.exr "
               "--focal-length 36 --sensor-width 36 --lens-radius 0.06 --focus-distance 5"},
              {"Warp views of few samples, with what a denoiser made of them",
               "ldi-warp center.exr view_*.exr --denoised smooth.center.exr smooth.view_*.exr -o ldi.exr"},
              {"Warp, cluster and gather in a pipe",
               "ldi-warp center.exr view_*.exr -o - | ldi-cluster - -o - | dof-gather - -o picture.exr"}});
}

} // namespace sparselens
