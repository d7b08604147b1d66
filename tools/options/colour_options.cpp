#include "options/colour_options.h"

#include <CLI/CLI.hpp>

namespace sparselens {

void add_input_colour_options(CLI::App &app, ColourOptions &options) {
    app.add_option("--colorconfig", options.config,
                   "OpenColorIO configuration (default: $OCIO, else the built-in one)")
        ->type_name("FILE")
        ->group("Colour");
    app.add_option("--colorspace", options.input_space,
                   "Colour space of the input (default: by its chromaticities or colorInteropID, else the "
                   "file rules of "
                   "the configuration)")
        ->type_name("SPACE")
        ->group("Colour");
}

void add_output_colour_options(CLI::App &app, ColourOptions &options) {
    CLI::Option *space =
        app.add_option(
               "--output-colorspace", options.output_space,
               "Colour space of the output (default: that of the input for EXR, else that of the display)")
            ->type_name("SPACE")
            ->group("Colour");
    app.add_option("--display", options.display,
                   "Display for PNG, JPEG and TIFF (default: that of the configuration)")
        ->type_name("DISPLAY")
        ->group("Colour")
        ->excludes(space);
    app.add_option("--view-transform", options.view,
                   "View transform of the display (default: that of the display)")
        ->type_name("VIEW")
        ->group("Colour")
        ->excludes(space);
}

} // namespace sparselens
