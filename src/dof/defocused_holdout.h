// A holdout that is out of focus like the scene. Its samples hide what is behind them at every lens point, but they are
// not shown and leave no coverage of their own.
//
// They are merged into the LDI without colour. Extra channels carry their coverage, so that it can be subtracted again
// after the gather, by any method.
#pragma once

#include "../base/image.h"
#include "../deep/ldi.h"

namespace sparselens {

// Returns the LDI to gather, which is tidy. Both LDIs must be tidy.
Ldi with_holdout(const Ldi &ldi, const Ldi &holdout);

// Removes the coverage of the holdout, and the extra channels, from a picture gathered from that LDI.
Image without_holdout(Image picture);

} // namespace sparselens
