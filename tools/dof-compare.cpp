// dof-compare: how far a picture is from its reference.
#include "base/error.h"
#include "harness/examples.h"
#include "harness/tool.h"
#include "io/exr/exr_flat.h"
#include "loading/notices.h"
#include "loading/region_file.h"
#include "measure/figures_text.h"
#include "measure/image_error.h"
#include "measure/regions.h"
#include "options/lens_options.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <vector>

namespace {

using namespace sparselens;

struct Options {
    std::string image, reference, regions;
    bool json = false;
    LensValues lens;
    DepthOptions depth;
};

void add_options(CLI::App &app, Options &options) {
    app.add_option("IN", options.image, "Picture to judge (EXR); - for standard input")
        ->required()
        ->type_name("");
    app.add_option("REF", options.reference,
                   "Reference (EXR), over whose data window the pictures are compared")
        ->required()
        ->type_name("");
    app.add_flag("--json", options.json, "Print JSON instead of a table");
    CLI::Option *regions =
        app.add_option(
               "--regions", options.regions,
               "Also compare by region: in focus, blurred, silhouettes, as this LDI tells (deep EXR, or flat "
               "with depth)")
            ->type_name("LDI");
    add_lens_options(app, options.lens);
    add_depth_options(app, options.depth);
    for (CLI::Option *option : app.get_options())
        if (option->get_group() == "Lens" && !option->check_lname("stereo-view"))
            option->needs(regions); // they say how to read that file
    add_examples(app, {{"Compare a picture with its reference", "dof-compare picture.exr reference.exr"},
                       {"... also in focus, in the blur and at silhouettes, as JSON",
                        "dof-compare picture.exr reference.exr --regions ldi.exr --json"}});
}

void compare(const Options &options, const ToolContext &tool) {
    const auto from_stdin = {options.image == "-", options.reference == "-", options.regions == "-"};
    if (std::ranges::count(from_stdin, true) > 1)
        throw UsageError("standard input (-) cannot be read twice: give one file by its name");
    const auto read = [&](const std::string &path) {
        FlatFile file = read_flat_exr(path, options.depth.view);
        say_reading(tool, path, file.notes, file.warnings);
        return std::move(file.image);
    };
    const Image reference_file = read(options.reference);
    const Windows &windows = reference_file.windows;
    const Image reference = rgba_over(reference_file, windows, options.reference);
    const Image image = rgba_over(read(options.image), windows, options.image);

    std::vector<std::uint8_t> bits;
    if (!options.regions.empty())
        bits = regions_over(windows, options.regions, {options.lens, options.depth}, tool);
    const auto figures = image_error(image, reference, bits, bits.empty() ? 0 : region_names.size());

    std::vector<NamedFigures> regions;
    for (std::size_t r = 1; r < figures.size(); ++r) regions.push_back({region_names[r - 1], figures[r]});
    const auto as_text = options.json ? figures_as_json : figures_as_table;
    const std::string text = as_text(figures.front(), regions);
    if (std::fputs(text.c_str(), stdout) == EOF || std::fflush(stdout) != 0)
        throw Error("standard output: cannot write");
}

} // namespace

int main(int argc, char **argv) {
    CLI::App app("Prints how far a picture is from its reference", "dof-compare");
    Options options;
    add_options(app, options);
    return run_tool(app, argc, argv, [&](const ToolContext &tool) { compare(options, tool); });
}
