#include "options/view_list.h"

#include <CLI/CLI.hpp>

namespace sparselens {

void add_view_list(CLI::App &app, ViewList &list) {
    app.add_option("views", list.files,
                   "Centre view, then views with their camera in the metadata; - for standard input")
        ->type_name("CENTER.exr [VIEW.exr ...]")
        ->required();
    app.add_option("--view", list.placed,
                   "View whose camera stood X right and Y up of the centre, in scene units")
        ->type_name("X,Y VIEW.exr")
        ->allow_extra_args(false);
}

} // namespace sparselens
