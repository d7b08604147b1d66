// dof-compare: measures how far a picture is from its reference, and how steady a sequence is.
#include "base/error.h"
#include "chain/notices.h"
#include "chain/regions.h"
#include "harness/commands/frames.h"
#include "harness/tool.h"
#include "io/exr/exr_flat.h"
#include "measure/figures_text.h"
#include "measure/image_error.h"
#include "measure/regions.h"
#include "measure/temporal_error.h"
#include "options/picture_options.h"

#include <CLI/CLI.hpp>
#include <ImathMatrix.h>
#include <ImfStandardAttributes.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace {

using namespace sparselens;

struct Options {
    std::string image, reference, second_reference, regions, frames;
    bool json = false;
    LensValues lens;
    DepthOptions depth;
};

void add_options(CLI::App &app, Options &options) {
    app.add_option("IN", options.image, "Picture to judge (EXR); - for standard input")
        ->required()
        ->type_name("");
    app.add_option("REF", options.reference,
                   "Reference (EXR); its data window is compared. Optional with --frames")
        ->type_name("");
    CLI::Option *second =
        app.add_option("REF_2", options.second_reference,
                       "Another reference that shares no noise with REF. psnr_without_noise is then the "
                       "tone-mapped error without their noise; other figures use the mean of both")
            ->type_name("");
    app.add_flag("--json", options.json, "Print JSON instead of a table");
    CLI::Option *regions = app.add_option("--regions", options.regions,
                                          "Also compare by region: in focus, blurred, silhouettes. The "
                                          "regions come from this LDI (deep EXR, or flat with depth)")
                               ->type_name("LDI");
    app.add_option("--frames", options.frames,
                   "Compare over time: how steady a sequence is (names hold #### or %04d), and how its "
                   "changes differ from those of REF, if given. RANGE is e.g. 1-16")
        ->type_name("RANGE")
        ->excludes(second)
        ->excludes(regions);
    add_parameters(app, lens_parameters(), options.lens);
    add_depth_options(app, options.depth);
    for (CLI::Option *option : app.get_options())
        if (option->get_group() == "Lens" && !option->check_lname("stereo-view") &&
            !option->check_lname("layer"))
            option->needs(regions); // regions say how to read that file
    add_examples(app, {{"Compare a picture with its reference", "dof-compare picture.exr reference.exr"},
                       {"... without the noise of two references",
                        "dof-compare picture.exr reference.exr another.exr"},
                       {"... also in focus, in the blur and at silhouettes, as JSON",
                        "dof-compare picture.exr reference.exr --regions ldi.exr --json"},
                       {"Find what sparkles in a pull of focus", "dof-compare pull.####.exr --frames 1-3"}});
}

Image read_picture(const std::string &path, const Options &options, const ToolContext &tool) {
    FlatFile file = read_flat_exr(path, options.depth.picture);
    notify_reading(tool.notify(), path, file.notes, file.warnings);
    return std::move(file.image);
}

std::optional<Image> second_reference(const Options &options, const Windows &windows,
                                      const ToolContext &tool) {
    if (options.second_reference.empty()) return {};
    return rgba_over(read_picture(options.second_reference, options, tool), windows,
                     options.second_reference);
}

void compare_pictures(const Options &options, const ToolContext &tool) {
    if (options.reference.empty())
        throw UsageError("REF is required: name the reference, or a sequence by --frames");
    const auto from_stdin = {options.image == "-", options.reference == "-", options.second_reference == "-",
                             options.regions == "-"};
    if (std::ranges::count(from_stdin, true) > 1)
        throw UsageError("standard input (-) cannot be read twice: give one file by its name");
    const Image reference_file = read_picture(options.reference, options, tool);
    const Windows &windows = reference_file.windows;
    Image reference = rgba_over(reference_file, windows, options.reference);
    const Image image = rgba_over(read_picture(options.image, options, tool), windows, options.image);

    std::optional<Image> first;
    const auto second = second_reference(options, windows, tool);
    if (second) {
        if (second->values == reference.values)
            throw Error(fmt::format("{}: has the same noise as {}: render each with a seed of its own",
                                    options.second_reference, options.reference));
        first = std::move(reference);
        reference = mean_of_references(*first, *second);
    }

    std::vector<std::uint8_t> bits;
    if (!options.regions.empty())
        bits = regions_over(windows, options.regions, {options.lens, options.depth}, tool.notify());
    const std::size_t count = bits.empty() ? 0 : region_names.size();
    auto figures = image_error(image, reference, bits, count);
    if (second) {
        const auto errors = error_without_noise(image, *first, *second, bits, count);
        for (std::size_t r = 0; r < figures.size(); ++r) figures[r].without_noise = errors[r];
    }

    std::vector<NamedFigures> regions;
    for (std::size_t r = 1; r < figures.size(); ++r) regions.push_back({region_names[r - 1], figures[r]});
    const auto as_text = options.json ? figures_as_json : figures_as_table;
    print(as_text(figures.front(), regions));
}

void compare_sequences(const Options &options, const ToolContext &tool) {
    std::vector<std::string> words{options.image};
    if (!options.reference.empty()) words.push_back(options.reference);
    words.insert(words.end(), {"--frames", options.frames});
    const FrameCommands frames(words);
    if (frames.size() < 3)
        throw UsageError(fmt::format("--frames {}: give three frames or more, to measure how steady they are",
                                     options.frames));
    TemporalError error;
    std::optional<Windows> windows;    // of the first frame
    std::optional<Imath::M44f> camera; // of the last one that tells it
    bool moves = false;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const std::vector<std::string> names = frames.words(i);
        const auto read = [&](const std::string &path) {
            const Image image = read_picture(path, options, tool);
            if (!windows) windows = image.windows;
            const Imf::Header header = read_flat_header(path, options.depth.picture);
            if (Imf::hasWorldToCamera(header)) {
                moves |= camera && *camera != Imf::worldToCamera(header);
                camera = Imf::worldToCamera(header);
            }
            return rgba_over(image, *windows, path);
        };
        const auto reference =
            options.reference.empty() ? std::nullopt : std::optional<Image>(read(names[1]));
        error.add(read(names[0]), reference ? &*reference : nullptr);
    }
    if (moves && options.reference.empty())
        warn(tool, options.image + ": the camera moves, so most pixels change, and the figures do not show "
                                   "how steady the pictures are: give REF, and compare with its figures");
    print(options.json ? temporal_as_json(error.figures()) : temporal_as_table(error.figures()));
}

} // namespace

int main(int argc, char **argv) {
    CLI::App app("Prints how far a picture is from its reference", "dof-compare");
    Options options;
    add_options(app, options);
    return run_tool(app, argc, argv, [&](const ToolContext &tool) {
        options.frames.empty() ? compare_pictures(options, tool) : compare_sequences(options, tool);
    });
}
