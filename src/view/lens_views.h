// Many views of one lens: where each stood on it.
#pragma once

#include "view/camera.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sparselens {

struct LensViews {
    std::vector<Imath::V2d> positions; // relative to the lens centre, scene units, x right, y up
    Camera centre;                     // the camera at the lens centre
    bool centre_guessed = false;       // it is only the mean of the views' positions
};

// From the views' worldToCamera. The lens centre is where `centre` stands; else where the views say it is
// (each names its own lens point); else the mean of their positions. UsageError: a view has no worldToCamera.
// Error: axes not parallel, or views not in one plane across the lens (off by more than a hundredth of their
// spread). Messages name the view by `names`.
LensViews place_on_lens(std::span<const Camera> views, std::span<const std::string> names,
                        const std::optional<Camera> &centre);

// `camera` moved across the lens, x right, y up, scene units: its matrices follow.
Camera moved_across_lens(Camera camera, const Imath::V2d &by);

} // namespace sparselens
