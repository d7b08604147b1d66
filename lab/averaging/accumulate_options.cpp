#include "lab/averaging/accumulate_options.h"

#include "harness/tool.h"
#include "options/picture_options.h"

#include <CLI/CLI.hpp>

#include <map>

namespace sparselens {

void add_accumulate_options(CLI::App &app, AccumulateOptions &options) {
    const std::map<std::string, bool> outside{{"unknown", false}, {"transparent", true}};
    app.add_option("VIEW", options.views.files, "Views whose cameras are in their metadata (EXR)");
    app.add_option("--view", options.views.placed,
                   "View whose camera stood X right and Y up of the lens centre, in scene units")
        ->type_name("X,Y VIEW")
        ->allow_extra_args(false);
    app.add_option("--center", options.views.centre,
                   "EXR file whose camera stands at the lens centre (default: the lens point in the views' "
                   "metadata, else the mean of their positions)")
        ->type_name("FILE");
    app.add_option("-o,--output", options.output, "Average to write (EXR); - for standard output")
        ->required()
        ->type_name("OUT.exr");
    add_type_option(app, options.type);
    add_compression_option(app, options.compression, false);
    app.add_option("--outside", options.transparent_outside,
                   "Pixels outside the data window of a view. unknown: the view does not count there; "
                   "transparent: they are black, within the display window (default: unknown)")
        ->type_name("unknown|transparent")
        ->transform(words(outside));
    add_parameters(app, lens_parameters(), options.lens);
    add_parameters(app, choice_parameters(), options.views.picture);
    add_history_option(app, options.history);
    add_examples(app, {{"Average views that say where their cameras stood",
                        "dof-accumulate view_*.exr --center center.exr -o average.exr"}});
}

} // namespace sparselens
