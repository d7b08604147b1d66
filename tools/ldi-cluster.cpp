// ldi-cluster: merges deep pictures, and the samples of each pixel to fewer.
#include "deep/cluster.h"
#include "harness/examples.h"
#include "harness/history.h"
#include "harness/stats.h"
#include "harness/tool.h"
#include "io/camera/camera_write.h"
#include "io/exr/exr_deep.h"
#include "chain/merge_ldis.h"
#include "loading/notices.h"
#include "loading/recoloured.h"
#include "options/colour_options.h"
#include "options/lens_options.h"
#include "options/picture_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

using namespace sparselens;

namespace {

struct Options {
    LensValues lens;
    DepthOptions depth;
    ColourOptions colour;
    HistoryOptions history;
    std::vector<std::string> inputs, depth_files;
    std::string output, recolor;
    std::optional<double> tolerance;
    std::optional<int> supersample;
    int layers = 0;
    AskedCompression compression;
};

void add_options(CLI::App &app, Options &options) {
    app.add_option("IN", options.inputs,
                   "LDI, any deep EXR or flat RGBA+Z; - for standard input. Several are merged by depth")
        ->type_name("...")
        ->required();
    app.add_option("-o,--output", options.output, "LDI to write; - for standard output")
        ->type_name("OUT.exr")
        ->required()
        ->check(output_name(OutputKind::exr));
    app.add_option("--tolerance", options.tolerance,
                   "Merge samples whose circles of confusion differ by less, in pixels (default: 0.25)")
        ->type_name("PX")
        ->check(number(at_least_0));
    app.add_option("--layers", options.layers, "Keep at most K samples per pixel; 0: no limit (default: 0)")
        ->type_name("K")
        ->check(CLI::Range(0, 1 << 20));
    add_recolor_option(app, options.recolor);
    add_input_colour_options(app, options.colour);
    for (const char *of_beauty : {"--colorspace", "--colorconfig"})
        app.get_option(of_beauty)->needs("--recolor");
    add_compression_option(app, options.compression, true);
    add_lens_options(app, options.lens);
    add_subpixels_option(app, options.supersample);
    add_depth_options(app, options.depth);
    add_depth_files_option(app, options.depth_files);
    add_history_option(app, options.history);
    add_examples(app, {{"Merge samples that no lens tells apart", "ldi-cluster ldi.exr -o small.exr"},
                       {"Merge the deep pictures of two elements by depth, and change nothing else",
                        "ldi-cluster front.exr back.exr -o shot.exr --tolerance 0"},
                       {"Give deep samples the colours of a flat picture of the same frame",
                        "ldi-cluster deep.exr --recolor beauty.exr -o shot.exr"}});
}

OpenedLdi open_merged(const Options &options, const ToolContext &tool) {
    const std::vector<DepthOptions> depths =
        depths_of_pictures(options.depth, options.depth_files, options.inputs.size());
    std::vector<OpenedLdi> parts;
    for (std::size_t i = 0; i < depths.size(); ++i) {
        parts.push_back(open_ldi(options.inputs[i], {options.lens, depths[i]}));
        if (options.supersample) parts.back().camera.supersample = options.supersample;
        say_samples(tool, parts.back());
        warn_of_invalid_values(tool, options.inputs[i], parts.back().bad);
    }
    return merge_ldis(std::move(parts));
}

Stats cluster_stats(const OpenedLdi &in, const Clustered &out) {
    return {{"samples_invisible", in.invisible},
            {"samples_read", in.ldi.samples()},
            {"samples", out.ldi.samples()},
            {"samples_merged", in.ldi.samples() - out.ldi.samples()},
            {"largest_coc_change", out.largest_error}};
}

void run(const Options &options, const ToolContext &tool) {
    OpenedLdi in = open_merged(options, tool);
    recolor_by(tool, options.recolor, options.depth.picture, options.colour, in);
    ClusterOptions by{.layers = options.layers};
    // --layers alone needs no lens, as inverse depths are compared without a scale, and --tolerance 0 none either.
    const double tolerance = options.tolerance.value_or(0.25);
    const bool must_know = tolerance > 0 && (options.tolerance || options.layers == 0);
    const auto scale = perceptive_scale(in.camera, in.ldi.windows, must_know);
    if (scale) by.scale = *scale;
    if (scale) by.tolerance = tolerance;
    const Clustered out = cluster(in.ldi, by, *tool.progress);
    tool.say(fmt::format("{} samples to {}, ", in.ldi.samples(), out.ldi.samples()) +
             (scale ? fmt::format("CoC changed by at most {:.6f} px", out.largest_error)
                    : "by inverse depth alone, because the lens is unknown"));
    write_camera(in.header, in.camera);
    append_history(in.header, tool, options.history);
    warn_of_clamped(tool, options.output, write_ldi(options.output, out.ldi, in.header, options.compression));
    write_stats(tool, cluster_stats(in, out));
}

} // namespace

int main(int argc, char **argv) {
    return run_frames("ldi-cluster", "Merges the samples of each pixel by perceptive depth", argc, argv,
                      [&](CLI::App &app) {
                          const auto options = std::make_shared<Options>();
                          add_options(app, *options);
                          return Job{[options](const ToolContext &tool) { run(*options, tool); }};
                      });
}
