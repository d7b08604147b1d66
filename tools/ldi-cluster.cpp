// ldi-cluster: merges deep pictures, and reduces the samples in each pixel.
#include "chain/make_ldi.h"
#include "chain/notices.h"
#include "harness/history.h"
#include "harness/tool.h"
#include "io/exr/exr_deep.h"
#include "options/picture_options.h"

#include <CLI/CLI.hpp>

using namespace sparselens;

namespace {

struct Options : ClusterRequest {
    HistoryOptions history = {};
    std::string output = {};
    AskedCompression compression = {};
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
    app.add_option(
           "--tolerance", options.tolerance,
           "Merge samples whose circles of confusion differ by less than this, in pixels (default: 0.25)")
        ->type_name("PX")
        ->check(number(at_least_0));
    app.add_option("--layers", options.layers,
                   "Largest number of samples in a pixel; 0: no limit (default: 0)")
        ->type_name("K")
        ->check(CLI::Range(0, 1 << 20));
    add_recolor_option(app, options.recolor);
    add_parameters(app, input_colour_parameters(), options.colour);
    for (const char *of_beauty : {"--colorspace", "--colorconfig"})
        app.get_option(of_beauty)->needs("--recolor");
    add_compression_option(app, options.compression, true);
    add_parameters(app, lens_parameters(), options.lens);
    add_subpixels_option(app, options.supersample);
    add_depth_options(app, options.depth);
    add_parameters(app, kind_parameters(), options.depth.picture);
    add_depth_files_option(app, options.depth_files);
    add_history_option(app, options.history);
    add_examples(app, {{"Merge samples that no lens tells apart", "ldi-cluster ldi.exr -o small.exr"},
                       {"Merge the deep pictures of two elements by depth, and change nothing else",
                        "ldi-cluster front.exr back.exr -o shot.exr --tolerance 0"},
                       {"Give deep samples the colours of a flat picture of the same frame",
                        "ldi-cluster deep.exr --recolor beauty.exr -o shot.exr"}});
}

Stats cluster_stats(const ClusteredLdi &made) {
    return {{"samples_invisible", made.invisible},
            {"samples_read", made.samples_read},
            {"samples", made.ldi.samples()},
            {"samples_merged", made.samples_read - made.ldi.samples()},
            {"largest_coc_change", made.largest_error}};
}

void run(const Options &options, const ToolContext &tool) {
    ClusteredLdi made = cluster_ldi(options, *tool.progress, tool.notify());
    append_history(made.header, tool, options.history);
    notify_clamped(tool.notify(), options.output,
                   write_ldi(options.output, made.ldi, made.header, options.compression));
    write_stats(tool, cluster_stats(made));
}

} // namespace

int main(int argc, char **argv) {
    return run_frames("ldi-cluster", "Merges the samples of each pixel by disparity", argc, argv,
                      [&](CLI::App &app) {
                          const auto options = std::make_shared<Options>();
                          add_options(app, *options);
                          return Job{[options](const ToolContext &tool) { run(*options, tool); }};
                      });
}
