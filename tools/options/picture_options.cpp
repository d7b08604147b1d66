#include "options/picture_options.h"

#include "base/error.h"
#include "gpu/device_list.h"
#include "harness/progress_lines.h"
#include "harness/tool.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace sparselens {

Imath::V2d view_offset(const std::string &text) {
    Imath::V2d offset;
    if (!read_numbers(text, {&offset.x, 2}) || !std::isfinite(offset.x) || !std::isfinite(offset.y))
        throw UsageError(fmt::format("--view: must be X,Y (e.g. 0.05,0), not '{}'", text));
    return offset;
}

void add_recolor_option(CLI::App &app, std::string &path) {
    app.add_option("--recolor", path,
                   "Flat picture of the same frame (EXR), whose colours and light passes replace those of "
                   "the samples")
        ->type_name("BEAUTY.exr");
}

void add_tiles_option(CLI::App &app, int &tiles) {
    app.add_option("--tiles", tiles,
                   "Size of the tiles of EXR output, in pixels; viewers and Nuke read parts of tiled files "
                   "faster. 0: scanlines (default: 0)")
        ->type_name("N")
        ->check(CLI::Range(0, 8192));
}

CLI::Validator output_name(OutputKind kind) {
    return {[kind](const std::string &path) { return wrong_with_output(path, kind); }, ""};
}

void add_type_option(CLI::App &app, std::optional<PixelType> &type) {
    const std::map<std::string, PixelType> types{{"half", PixelType::half}, {"float", PixelType::float32}};
    app.add_option("-d", type, "Type of the channels written (default: that of the input)")
        ->type_name("half|float")
        ->transform(words(types));
}

void add_compression_option(CLI::App &app, AskedCompression &compression, bool deep) {
    const auto read = [&compression, deep](const std::string &text) {
        const auto found = std::ranges::find(compressions(), text, &NamedCompression::name);
        if (found == compressions().end() || (deep && !found->deep))
            throw CLI::ValidationError("--compression", fmt::format("{} files have one of {}, not '{}'",
                                                                    deep ? "deep" : "flat",
                                                                    compression_names(deep, ", "), text));
        compression = found->value;
    };
    app.add_option_function<std::string>(
           "--compression", read,
           deep ? "Compression of the LDI (default: that of a deep input, else zips; none into a pipe)"
                : "Compression of EXR output (default: that of a flat input, else zip; none into a pipe)")
        ->type_name(compression_names(deep, "|"));
}

Image in_type(Image image, std::optional<PixelType> type) {
    for (Channel &channel : image.channels)
        if (type && !holds_ids(channel)) channel.type = *type;
    return image;
}

void add_device_option(CLI::App &app, std::string &device, const std::string &what_works) {
    const auto list = [](const std::string &word) {
        if (word != "list") return;
        std::string lines;
        for (const gpu::DeviceInfo &there : gpu::list_devices()) lines += "\n" + gpu::description(there);
        throw CLI::CallForVersion(lines.empty() ? gpu::no_devices : lines.substr(1), 0);
    };
    app.add_option(
           "--device", device,
           what_works +
               ". cpu: the CPU; auto: a GPU if there is one; gpu: a GPU, else an error; a part of a device's "
               "name: this device, even one in software; list: print all devices (default: cpu)")
        ->type_name("cpu|auto|gpu|list")
        ->group("Device")
        ->envname("SPARSELENS_DEVICE")
        ->each(list);
}

CLI::Validator number(NumberRange range) {
    const auto check = [range](const std::string &text) -> std::string {
        double value = 0;
        if (CLI::detail::lexical_cast(text, value) && range.holds(value)) return {};
        return "'" + text + "' is not " + range.words;
    };
    return CLI::Validator(check, "");
}

void add_parameter(CLI::App &app, const Parameter &row, std::function<bool(const std::string &)> put) {
    if (row.form == ParameterForm::device) return;
    const std::string name = "--" + row.name, help = with_options(row.help);
    const auto read = [&row, name, put](const std::string &text) {
        if (!put(text))
            throw CLI::ValidationError(name, fmt::format("must be {}, not '{}'", row.wanted, text));
    };
    CLI::Option *option = row.form == ParameterForm::flag
                              ? app.add_flag_callback(
                                    name, [put] { put(""); }, help)
                              : app.add_option_function<std::string>(name, read, help)->type_name(row.unit);
    if (row.form == ParameterForm::number && !row.or_share) option->check(number(row.range));
    if (row.form == ParameterForm::whole) option->check(CLI::Range(row.least, row.most));
    if (*row.group != '\0') option->group(row.group);
    for (const Parameter *other : picture_parameters())
        if (CLI::Option *there = app.get_option_no_throw("--" + other->name)) {
            if (exclude(row.name, other->name)) option->excludes(there);
            if (needs(row.name, other->name)) option->needs(there);
        }
}

void add_depth_options(CLI::App &app, DepthOptions &options) {
    add_parameters(app, depth_parameters(), options);
    add_parameters(app, choice_parameters(), options.picture);
}

void add_depth_files_option(CLI::App &app, std::vector<std::string> &files) {
    app.add_option("--depth-file", files,
                   "Flat EXR with the depth of a picture, one for each picture, in the same order")
        ->type_name("FILE.exr")
        ->allow_extra_args(false)
        ->group("Lens");
}

void add_subpixels_option(CLI::App &app, std::optional<int> &across) {
    app.add_option("--supersample", across,
                   "Number of pixels of the files, across and down, that make one pixel of the picture "
                   "(default: as the files say, else 1)")
        ->type_name("N")
        ->check(CLI::Range(1, most_across))
        ->group("Lens");
}

} // namespace sparselens
