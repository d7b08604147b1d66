// The camera of a layer of USD, as options.
#pragma once

#include "chain/stated_camera.h"
#include "harness/commands/cli.h"

namespace sparselens {

// --camera, --camera-name and --camera-frame. `camera` must not move until the command line is parsed.
void add_camera_options(CLI::App &app, CameraRequest &camera);

} // namespace sparselens
