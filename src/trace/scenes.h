// The test scenes by name.
#pragma once

#include "trace/scene.h"

#include <span>

namespace sparselens {

struct SceneEntry {
    const char *name;
    const char *summary;
    Scene (*build)();
};

std::span<const SceneEntry> scene_table();

} // namespace sparselens
