// Merges several layered pictures of one camera: each is an object, or a layer of the same samples.
#pragma once

#include "ldi.h"

#include <string>
#include <vector>

namespace sparselens {

// Whether both LDIs have samples at the same positions, in the same order.
bool same_samples(const Ldi &a, const Ldi &b);

// Adds the channels of `layer`, which has the same samples as `ldi`. If a channel's name is taken, the channel becomes
// one of the layer `name`; if that name is taken too, the first channel is kept.
void add_layer(Ldi &ldi, Ldi layer, const std::string &name);

// All samples of the parts, ready for tidy(): pixel by pixel, the samples of the first part first. The display window
// is the first part's; the data window contains those of all parts. A channel that a part lacks is 0 in its samples,
// except for coverage: without A they are opaque, and without per-channel alpha AR, AG and AB equal A.
Ldi deep_merge(const std::vector<Ldi> &parts);

} // namespace sparselens
