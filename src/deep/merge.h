// Merges several layered pictures of one camera: each is an object, or a layer of the same samples.
#pragma once

#include "ldi.h"

#include <string>
#include <vector>

namespace sparselens {

// Whether both have samples at the same positions, in the same order.
bool same_samples(const Ldi &a, const Ldi &b);

// Adds the channels of `layer`, which has the same samples as `ldi`. A channel whose name is taken becomes a channel of
// the layer of that name; where that is taken too, the first one is kept.
void add_layer(Ldi &ldi, Ldi layer, const std::string &name);

// All samples of the parts, ready for tidy(): pixel by pixel, those of the first part first. The display window is that
// of the first part; the data window contains those of all parts. A channel that a part lacks is 0 there, except for
// coverage: without A its samples are opaque, and without per-channel alpha that is A.
Ldi deep_merge(const std::vector<Ldi> &parts);

} // namespace sparselens
