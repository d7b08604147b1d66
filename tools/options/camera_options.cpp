#include "options/camera_options.h"

#include <CLI/CLI.hpp>

namespace sparselens {

void add_camera_options(CLI::App &app, CameraRequest &camera) {
    CLI::Option *file =
        app.add_option(
               "--camera", camera.file,
               "Layer of USD whose cameras give position, frustum, focus and f-stop, instead of the files "
               "of the views; each view has the camera of its name (view_0.exr: view_0)")
            ->type_name("SHOT.usda")
            ->group("Lens");
    app.add_option("--camera-name", camera.name,
                   "Camera of the centre view: its path or its name (default: the only one, or center)")
        ->type_name("NAME")
        ->needs(file)
        ->group("Lens");
    app.add_option("--camera-frame", camera.frame,
                   "Time code at which the camera is read (default: the number of the frame)")
        ->type_name("N")
        ->needs(file)
        ->group("Lens");
}

} // namespace sparselens
