// The curve of a shutter, by the name of a shape or from a text file.
#pragma once

#include "shutter/shutter_curve.h"

#include <string>

namespace sparselens {

// "box", "triangle" or "gaussian" ("" is a box), or the name of a file. Each line of a file is a time and a value, as
// in ShutterCurve; lines that begin with # and empty lines do not count. Throws Error, naming file and line, if the
// file cannot be read or understood.
ShutterCurve shutter_curve(const std::string &name);

} // namespace sparselens
