// The command line of ldi-plan.
#pragma once

#include "chain/plan_views.h"
#include "chain/stated_camera.h"
#include "harness/commands/cli.h"

#include <optional>
#include <string>

namespace sparselens {

struct PlanCommand {
    std::string centre; // empty: only cameras, by `camera`
    std::string output, masks, cameras;
    CameraRequest camera;
    std::optional<char> up_axis;
    std::optional<Imath::V2i> size; // of the picture, without a centre view
    LensValues lens;
    DepthOptions depth;
    PlanOptions plan;
    std::optional<int> supersample;
    std::optional<int> rays;
};

void add_plan_options(CLI::App &app, PlanCommand &options);

} // namespace sparselens
