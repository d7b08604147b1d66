#include "options/gather_options.h"

#include "base/error.h"
#include "harness/progress_lines.h"
#include "harness/tool.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>

namespace sparselens {

namespace {

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

void add_gather_examples(CLI::App &app) {
    add_examples(app,
                 {{"Make the picture with the lens of the file", "dof-gather ldi.exr -o picture.exr"},
                  {"Focus on the surface in pixel 100,60, stop down, and write a PNG",
                   "dof-gather ldi.exr -o picture.png --focus-pixel 100,60 --fstop 2"},
                  {"Pull the focus over 12 frames",
                   "dof-gather ldi.exr -o pull.####.exr --frames 1-12 --focus-distance 1:2.0,12:5.0"},
                  {"Defocus one flat render without a lens in its file",
                   "dof-gather beauty.exr -o picture.exr --focal-length 35 --sensor-width 36 --fstop 0.5 "
                   "--focus-distance 5"}});
}

} // namespace

void add_picture_making_options(CLI::App &app, GatherCommand &options) {
    app.add_option("IN", options.input, "LDI, any deep EXR or flat RGBA+Z; - for standard input")
        ->type_name("")
        ->required();
    add_parameters<PictureRequest>(app, gather_parameters(), options);
    add_device_option(app, options.device, find_parameter("device")->help);
    add_parameters(app, lens_parameters(), options.lens);
    add_parameters(app, look_parameters(), options.looks);
    add_depth_options(app, options.depth);
    add_parameters(app, kind_parameters(), options.depth.picture);
    add_parameters(app, depth_file_parameters(), options.depth.picture);
    add_parameters(app, photograph_parameters(), options.depth);
    add_parameters(app, input_colour_parameters(), options.colour);
    add_parameters(app, output_colour_parameters(), options.colour);
    add_parameters(app, window_parameters(), options.windows);
    app.final_callback([&app, &options] { check(app, options); });
}

void add_gather_options(CLI::App &app, GatherCommand &options) {
    add_picture_making_options(app, options);
    app.add_option("-o,--output", options.output,
                   fmt::format("Picture to write ({}); - for standard output", picture_formats()))
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
    add_parameters<PictureRequest>(app, shown_parameters(), options);
    add_history_option(app, options.history);
    add_gather_examples(app);
}

} // namespace sparselens
