// The share of the lens points that one moment of a shutter takes.
#pragma once

namespace sparselens {

struct LensShare {
    int moment = 0;  // from 0
    int moments = 1; // of the shutter, at least 1; 1: the moment takes all lens points
};

} // namespace sparselens
