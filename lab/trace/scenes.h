// The test scenes by name.
#pragma once

#include "lab/trace/scene.h"

#include <span>
#include <string_view>

namespace sparselens::lab {

struct SceneEntry {
    const char *name;
    const char *summary;
    Scene (*build)();
};

std::span<const SceneEntry> scene_table();

// Throws Error if no scene has that name.
Scene build_scene(std::string_view name);

// The scene for a camera that has moved by `dolly` along z; the depths of slabs are counted from the camera.
Scene seen_after(Scene scene, double dolly);

} // namespace sparselens::lab
