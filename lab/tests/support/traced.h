// The test scenes as small ray-traced views and references.
#pragma once

#include "lab/trace/render.h"
#include "view/view.h"

#include <string_view>
#include <vector>

namespace sparselens::lab {

// A scene with its own lens. A size in the ratio 16:9 has the same framing as 640x360.
struct SceneCamera {
    SceneCamera(std::string_view name, int width, int height);
    SceneCamera(const Scene &scene, const ThinLens &lens, int width, int height);

    View view(const Imath::V2d &u, int samples, std::uint32_t stream) const; // position: lens.radius * u
    std::vector<View> five_views(int samples) const; // the centre, then the rim every 90 degrees
    Image reference(int samples) const;              // R G B A

    Tracer tracer;
    RenderSettings settings;
};

} // namespace sparselens::lab
