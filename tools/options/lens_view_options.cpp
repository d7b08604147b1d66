#include "options/lens_view_options.h"

#include <CLI/CLI.hpp>

namespace sparselens {

void add_lens_view_options(CLI::App &app, LensViewOptions &options) {
    app.add_option("VIEW", options.files, "Views whose cameras are in their metadata (EXR)");
    app.add_option("--view", options.placed, "A view moved X right and Y up of the lens centre, scene units")
        ->type_name("X,Y VIEW")
        ->allow_extra_args(false);
    app.add_option(
           "--center", options.centre,
           "EXR file whose camera stands at the lens centre (else the lens point in the views' metadata, "
           "else the mean of their positions)")
        ->type_name("FILE");
}

} // namespace sparselens
