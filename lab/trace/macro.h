// The scene "macro": a head of 0.1 m before a lens of 85 mm and f/1, with a steep relief that fills the picture, and
// small bright lamps behind it.
#pragma once

#include "lab/trace/scene.h"

namespace sparselens::lab {

Scene macro_scene();

} // namespace sparselens::lab
