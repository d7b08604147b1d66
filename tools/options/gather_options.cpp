#include "options/gather_options.h"

#include "base/error.h"
#include "harness/examples.h"
#include "harness/one_line.h"
#include "harness/words.h"
#include "options/device_option.h"
#include "options/picture_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>

namespace sparselens {

namespace {

// Throws where options contradict each other.
void check(const CLI::App &parsed, const GatherCommand &options) {
    const auto is_given = [&](std::string name) {
        std::ranges::replace(name, '_', '-');
        const CLI::Option *option = parsed.get_option_no_throw("--" + name);
        return option && option->count() > 0;
    };
    try {
        check_method(options, is_given);
    } catch (const UsageError &error) {
        throw CLI::ValidationError(with_options(error.what()));
    }
}

void add_method_options(CLI::App &app, GatherCommand &options) {
    const char *lens_group = "Method lens";
    const std::map<std::string, Quality> qualities{
        {"draft", Quality::draft}, {"normal", Quality::normal}, {"final", Quality::final}};
    app.add_option("--quality", options.picture.gather.lens.quality,
                   "Trade of error against time (default: normal)")
        ->type_name("draft|normal|final")
        ->group(lens_group)
        ->transform(words(qualities));
    app.add_option("--lens-samples", options.picture.gather.lens.lens_samples,
                   "Number of lens points in every tile; 0: chosen by quality and picture (default: 0)")
        ->type_name("N")
        ->group(lens_group)
        ->check(CLI::Range(0, 1 << 20));
    app.add_option("--layer-tolerance", options.picture.layer_tolerance,
                   fmt::format("First merge layers of a pixel whose circles of confusion differ by less than "
                               "this, in pixels; 0: merge none (default: {})",
                               options.picture.layer_tolerance))
        ->type_name("PX")
        ->group(lens_group)
        ->check(number(at_least_0));
    app.add_option(
           "--layers", options.picture.gather.layers,
           fmt::format("Layers kept apart in each pixel (default: {})", options.picture.gather.layers))
        ->type_name("K")
        ->group("Method selective")
        ->check(CLI::Range(1, 4096));
    app.add_option("--holdout", options.holdout,
                   "Deep EXR that hides what is behind it, and is not shown; it stays sharp")
        ->type_name("DEEP.exr")
        ->group(lens_group);
    app.add_flag("--holdout-defocused", options.picture.holdout_defocused,
                 "Put the holdout out of focus, like the rest of the scene")
        ->group(lens_group)
        ->needs("--holdout");
}

void add_point_option(CLI::App &app, std::optional<Imath::V2d> &point) {
    const auto read = [&point](const std::string &text) {
        constexpr double most_rounded = 1.01; // a point of the rim by two digits
        point = parse_pair(text);
        if (point && point->length() > 1 && point->length() <= most_rounded) point->normalize();
        if (!point || point->length() > most_rounded)
            throw CLI::ValidationError(
                "--lens-point",
                fmt::format("must be X,Y at most 1 from the middle (e.g. 0.5,-0.5), not '{}'", text));
    };
    app.add_option_function<std::string>(
           "--lens-point", read,
           "Show what this point of the lens sees, X right and Y up of its middle, 1 at the rim. Tints areas "
           "that no view saw magenta; unknown areas are black")
        ->type_name("X,Y")
        ->group("Method lens");
}

void add_show_option(CLI::App &app, Show &show) {
    const std::map<std::string, Show> shows{
        {"coc", Show::coc}, {"focus", Show::focus}, {"layers", Show::layers}, {"tiles", Show::tiles}};
    app.add_option(
           "--show", show,
           "Write false colours instead of the picture. coc: circle of confusion; focus: what is in focus; "
           "layers: samples per pixel; tiles: lens points per tile, with --method lens")
        ->type_name("coc|focus|layers|tiles")
        ->transform(words(shows));
}

void add_gather_examples(CLI::App &app) {
    add_examples(
        app,
        {{"Make the picture through the lens that the file describes", "dof-gather ldi.exr -o picture.exr"},
         {"Focus on what pixel 100,60 shows, stop down, and write a PNG",
          "dof-gather ldi.exr -o picture.png --focus-pixel 100,60 --fstop 2"},
         {"Pull the focus over 12 frames",
          "dof-gather ldi.exr -o pull.####.exr --frames 1-12 --focus-distance 1:2.0,12:5.0"},
         {"Defocus one flat render that does not describe its lens",
          "dof-gather beauty.exr -o picture.exr --focal-length 35 --sensor-width 36 --fstop 0.5 "
          "--focus-distance 5"}});
}

} // namespace

void add_picture_making_options(CLI::App &app, GatherCommand &options) {
    app.add_option("IN", options.input, "LDI, any deep EXR or flat RGBA+Z; - for standard input")
        ->type_name("")
        ->required();
    add_method_option(app, options.picture.method);
    add_method_options(app, options);
    add_device_option(app, options.device, "Device that gathers, for the methods lens and selective");
    add_pixel_option(app, "--focus-pixel", options.focus_pixel,
                     "Focus on the front surface in this pixel, in EXR coordinates");
    app.add_option("--channels", options.channels,
                   "Channels or layers to gather, comma-separated (default: all)")
        ->type_name("LIST");
    add_lens_options(app, options.lens);
    add_look_options(app, options.looks);
    add_highlight_options(app, options.looks);
    add_depth_options(app, options.depth);
    add_depth_file_option(app, options.depth.picture.depth_file);
    add_input_colour_options(app, options.colour);
    add_output_colour_options(app, options.colour);
    add_window_options(app, options.windows);
    app.get_option("--focus-pixel")->excludes("--focus-distance");
    app.final_callback([&app, &options] { check(app, options); });
}

void add_gather_options(CLI::App &app, GatherCommand &options) {
    add_picture_making_options(app, options);
    app.add_option("-o,--output", options.output,
                   "Picture to write (EXR, PNG, JPEG or TIFF); - for standard output")
        ->type_name("OUT.exr")
        ->required()
        ->check(output_name(OutputKind::picture));
    app.add_option("--depth-out", options.depth_output, "Also write the depth of the front samples (EXR)")
        ->type_name("FILE.exr")
        ->each([&options](const std::string &) { options.front_depth = true; })
        ->check(output_name(OutputKind::exr));
    add_recolor_option(app, options.recolor);
    add_type_option(app, options.type);
    add_compression_option(app, options.compression, false);
    add_tiles_option(app, options.tiles);
    add_show_option(app, options.show);
    add_point_option(app, options.picture.gather.lens.point);
    add_history_option(app, options.history);
    add_gather_examples(app);
}

} // namespace sparselens
