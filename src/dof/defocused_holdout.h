// A holdout that is out of focus as well, as part of the scene: its samples hide what is behind them at every lens point,
// but are not shown and leave no coverage of their own.
//
// They are merged into the LDI without colour. Extra channels carry the coverage that belongs to them, so that after the
// gather, by any method, it can be subtracted again.
#pragma once

#include "../base/image.h"
#include "../deep/ldi.h"

namespace sparselens {

// The LDI to gather: tidy, as both must be.
Ldi with_holdout(const Ldi &ldi, const Ldi &holdout);

// The picture gathered from it, without the coverage of the holdout and without the extra channels.
Image without_holdout(Image picture);

} // namespace sparselens
