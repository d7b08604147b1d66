#include "options/gather_options.h"

#include "base/error.h"
#include "harness/examples.h"
#include "harness/one_line.h"
#include "harness/words.h"
#include "options/picture_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace sparselens {

namespace {

// Parses "x0,y0,x1,y1" with x0 <= x1 and y0 <= y1; nothing for other text.
std::optional<Imath::Box2i> parse_box(const std::string &text) {
    int v[4] = {};
    const char *at = text.data(), *const end = at + text.size();
    for (int i = 0; i < 4; ++i) {
        if (i > 0 && (at == end || *at++ != ',')) return {};
        const auto [after, error] = std::from_chars(at, end, v[i]);
        if (error != std::errc()) return {};
        at = after;
    }
    if (at != end || v[0] > v[2] || v[1] > v[3]) return {};
    return Imath::Box2i({v[0], v[1]}, {v[2], v[3]});
}

void add_window_options(CLI::App &app, WindowOptions &options) {
    const std::map<std::string, OutputOverscan> overscans{
        {"grow", OutputOverscan::grow}, {"keep", OutputOverscan::keep}, {"crop", OutputOverscan::crop}};
    app.add_option("--overscan", options.overscan,
                   "Pixels to make. grow: the pixels of the file, and beyond them as far as the blur reaches "
                   "in the display window; keep: the pixels of the file, which cuts the blur off; crop: the "
                   "pixels of the file in the display window (default: grow)")
        ->type_name("grow|keep|crop")
        ->transform(words(overscans))
        ->group("Windows");
    app.add_option("--proxy", options.proxy, "Make a picture of 1/N the size (default: 1)")
        ->type_name("N")
        ->check(CLI::Range(1, 1024))
        ->group("Windows");
    app.add_option("--supersample", options.supersample,
                   "Number of pixels of the file, across and down, that make one pixel of the picture; 1: "
                   "keep all pixels (default: as the file says, else 1)")
        ->type_name("N")
        ->check(CLI::Range(1, most_across))
        ->group("Windows");
    app.add_option_function<std::string>(
           "--pixel-filter",
           [&options](const std::string &text) {
               options.filter = pixel_filter_of(text);
               if (!options.filter)
                   throw CLI::ValidationError(
                       "--pixel-filter",
                       fmt::format("must be box, blackman-harris or gaussian, the latter two with :WIDTH in "
                                   "pixels if wanted, not '{}'",
                                   text));
           },
           "With --supersample, the renderer's pixel filter for the picture, and its width as in Cycles "
           "(default: as the file says, else box; width 1.5)")
        ->type_name("box|blackman-harris|gaussian[:WIDTH]")
        ->group("Windows");
    app.add_option_function<std::string>(
           "--region",
           [&options](const std::string &text) {
               options.region = parse_box(text);
               if (!options.region)
                   throw CLI::ValidationError("--region",
                                              fmt::format("must be X0,Y0,X1,Y1 (left, top, right and bottom, "
                                                          "all included), not '{}'",
                                                          text));
           },
           "Make only these pixels of the full-size picture, in EXR coordinates, with X1 and Y1 included")
        ->type_name("X0,Y0,X1,Y1")
        ->group("Windows");
}

// Throws if options contradict each other.
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
        constexpr double most_rounded = 1.01; // the length of a rim point rounded to two digits
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
