// A scene for motion blur: a wheel that turns, a ball that crosses behind a fence, lamps that streak, and a camera that
// pans. At 320x180 the wheel's rim moves by 15 pixels while the shutter is open, the ball by 18, the train's lamps by 15
// and the wall's by 6.
#pragma once

#include "lab/trace/scene.h"

namespace sparselens::lab {

Scene fair_scene();

} // namespace sparselens::lab
