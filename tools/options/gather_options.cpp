#include "options/gather_options.h"

#include "base/error.h"
#include "harness/words.h"
#include "options/picture_options.h"

namespace sparselens {

void add_gather_options(CLI::App &app, GatherCommand &options) {
    app.add_option("input", options.input, "LDI, any deep EXR or flat RGBA+Z; - for standard input")
        ->type_name("IN.exr")
        ->required();
    app.add_option("-o,--output", options.output,
                   "Picture to write: EXR, or PNG, JPEG, TIFF; - for standard output")
        ->type_name("OUT.exr")
        ->required();
    add_method_option(app, options.method);
    const std::map<std::string, Quality> qualities{
        {"draft", Quality::draft}, {"normal", Quality::normal}, {"final", Quality::final}};
    app.add_option("--quality", options.gather.lens.quality, "Error against time (lens; normal)")
        ->type_name("draft|normal|final")
        ->transform(words(qualities));
    app.add_option("--lens-samples", options.gather.lens.lens_samples,
                   "Lens points everywhere (lens), 0 = by the quality and what the picture needs")
        ->type_name("N")
        ->check(CLI::Range(0, 1 << 20));
    app.add_option("--layers", options.gather.layers, "Layers a pixel keeps apart (selective)")
        ->type_name("K")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    add_pixel_option(app, "--focus-pixel", options.focus_pixel, "Focus on what this pixel shows");
    app.add_option("--holdout", options.holdout,
                   "Deep EXR that hides what is behind it, and stays sharp (lens)")
        ->type_name("DEEP.exr");
    app.add_option("--depth-out", options.depth_output, "Write the depth of the front samples")
        ->type_name("FILE");
    app.add_option("--channels", options.channels, "Channels or layers to gather, comma-separated (all)")
        ->type_name("LIST");
    add_type_option(app, options.as_float);
    add_show_option(app, options.show);
    add_lens_options(app, options.lens);
    add_depth_options(app, options.depth);
    add_input_colour_options(app, options.colour);
    add_output_colour_options(app, options.colour);
    add_window_options(app, options.windows);
    add_history_option(app, options.history);
    app.get_option("--focus-pixel")->excludes("--focus-distance");
}

void check(const GatherCommand &options) {
    if (options.depth_output == options.output)
        throw UsageError("--depth-out and --output name the same file: " + options.output);
    if (!options.holdout.empty() && options.method != &gather_methods().front())
        throw UsageError("--holdout works with --method lens only");
    if (options.show == Show::tiles && options.method != &gather_methods().front())
        throw UsageError("--show tiles: only --method lens works by tiles");
}

} // namespace sparselens
