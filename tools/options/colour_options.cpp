#include "options/colour_options.h"

#include "base/error.h"
#include "io/display/shown_picture.h"
#include "io/exr/exr_flat.h"
#include "io/files/file_stream.h"
#include "io/files/memory_limit.h"

#include <ImfStringAttribute.h>

#include <optional>

namespace sparselens {

namespace {

// Empty where there is nothing to do.
std::optional<ColourTransform> to_scene_linear(const ToolContext &tool, const ColourOptions &options,
                                               const std::string &path, const Imf::Header &header) {
    const bool ours = header.findTypedAttribute<Imf::StringAttribute>("sparselens:version") != nullptr;
    if (options.input_space.empty() && (ours || path == "-" || path == display_name("-"))) return {};
    const ColourConfig config(options.config);
    const std::string from = options.input_space.empty() ? config.space_of_file(path) : options.input_space;
    const ColourTransform transform = config.between(from, config.scene_linear());
    tool.say(display_name(path) + ": colour space " + from);
    return transform;
}

ColourTransform output_transform(const ColourOptions &options, bool shown) {
    const ColourConfig config(options.config);
    if (!options.output_space.empty()) return config.between(config.scene_linear(), options.output_space);
    return shown ? config.to_display(options.display, options.view)
                 : config.between(config.scene_linear(), config.scene_linear());
}

} // namespace

void add_input_colour_options(CLI::App &app, ColourOptions &options) {
    app.add_option("--colorconfig", options.config,
                   "OpenColorIO configuration (default: $OCIO, else the built-in one)")
        ->type_name("FILE")
        ->group("Colour");
    app.add_option("--colorspace", options.input_space,
                   "Colour space of the input (default: by the file rules of the configuration)")
        ->type_name("SPACE")
        ->group("Colour");
}

void add_output_colour_options(CLI::App &app, ColourOptions &options) {
    CLI::Option *space =
        app.add_option("--output-colorspace", options.output_space,
                       "Colour space of the output (default: scene-linear for EXR, else that of the display)")
            ->type_name("SPACE")
            ->group("Colour");
    app.add_option("--display", options.display,
                   "Display for which PNG, JPEG and TIFF are made (default: that of the configuration)")
        ->type_name("DISPLAY")
        ->group("Colour")
        ->excludes(space);
    app.add_option("--view-transform", options.view,
                   "View transform of the display (default: that of the display)")
        ->type_name("VIEW")
        ->group("Colour")
        ->excludes(space);
}

void to_scene_linear(const ToolContext &tool, const ColourOptions &options, const std::string &path,
                     const Imf::Header &header, Ldi &ldi) {
    const auto transform = to_scene_linear(tool, options, path, header);
    if (!transform) return;
    const std::vector<std::span<float>> planes(ldi.values.begin(), ldi.values.end());
    transform_colours(*transform, ldi.channels, planes);
}

void to_scene_linear(const ToolContext &tool, const ColourOptions &options, const std::string &path,
                     const Imf::Header &header, View &view) {
    if (const auto transform = to_scene_linear(tool, options, path, header))
        transform_colours(*transform, view.image);
}

std::size_t write_picture(const ToolContext &tool, const ColourOptions &options, const std::string &path,
                          Image image, const Imf::Header &metadata) {
    const bool shown = is_shown_picture(path);
    if (!shown && !(options.display.empty() && options.view.empty()))
        throw UsageError("--display and --view-transform apply to PNG, JPEG and TIFF, not to " + path);
    if (shown || !options.output_space.empty()) transform_colours(output_transform(options, shown), image);
    if (!shown) return write_flat_exr(path, image, metadata);
    const Imath::Box2i &display = image.windows.display; // written as a whole
    check_memory(
        path, 3.0 * (double(display.max.x) - display.min.x + 1) * (double(display.max.y) - display.min.y + 1),
        image.values.size() * sizeof(float));
    write_shown_picture(path, image);
    tool.say(path + ": written with a display transform");
    return 0;
}

} // namespace sparselens
