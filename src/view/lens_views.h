// The positions of many views on their lens.
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
    bool centre_guessed = false;       // whether it is only the mean of the views' positions
};

// Computes the positions from the worldToCamera of the views. The lens centre is the position of `centre`, if given;
// otherwise what the views state, if each names its own lens point; otherwise the mean of their positions. Throws
// UsageError if a view has no worldToCamera, and Error if the axes are not parallel or a view lies farther in front of
// or behind the lens centre than any view lies beside it. Messages name the view by `names`.
LensViews position_on_lens(std::span<const Camera> views, std::span<const std::string> names,
                           const std::optional<Camera> &centre);

// Checks pictures that are shifted as a whole. Throws Error, naming the view, if its picture is smaller or larger than
// the centre's, or if its camera lies in front of or behind the centre by more than a hundredth of the spread of the
// views.
void require_one_plane(const LensViews &views, std::span<const std::string> names);

// `camera` moved across the lens (x right, y up, scene units), with its matrices.
Camera moved_across_lens(Camera camera, const Imath::V2d &by);

} // namespace sparselens
