// Scenes of 0.1 m before a lens of 85 mm and f/1, with small bright lamps behind them: "macro", a head with a steep
// relief that fills the picture; "scales", a cone of scales that partly hide the next ones.
#pragma once

#include "lab/trace/scene.h"

namespace sparselens::lab {

Scene macro_scene();
Scene scales_scene();

} // namespace sparselens::lab
