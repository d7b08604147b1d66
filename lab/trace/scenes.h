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

// Throws Error where no scene has that name.
Scene build_scene(std::string_view name);

// The same for a camera that has moved so far along z: depths of slabs are counted from it.
Scene seen_after(Scene scene, double dolly);

} // namespace sparselens::lab
