// Many views of one lens: where each stood on it.
#pragma once

#include "camera.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sparselens {

struct LensViews {
    std::vector<Imath::V2d> positions; // relative to the lens centre, scene units, x right, y up
    std::vector<Framing> framings;     // against the camera at the lens centre
    Camera centre;                     // the camera at the lens centre
    bool centre_guessed = false;       // it is only the mean of the views' positions
};

// From the views' worldToCamera. The lens centre is where `centre` stands; else where the views say it is
// (each names its own lens point); else the mean of their positions. UsageError: a view has no worldToCamera.
// Error: axes not parallel, or a view farther in front of or behind the lens centre than any is to its side. Messages
// name the view by `names`.
LensViews position_on_lens(std::span<const Camera> views, std::span<const std::string> names,
                           const std::optional<Camera> &centre);

// For pictures that are to be moved whole. Error, naming the view, where its picture is smaller or larger than the
// centre's, or its camera in front of or behind it by more than a hundredth of the views' spread.
void require_one_plane(const LensViews &views, std::span<const std::string> names);

// `camera` moved across the lens, x right, y up, scene units: its matrices follow.
Camera moved_across_lens(Camera camera, const Imath::V2d &by);

} // namespace sparselens
