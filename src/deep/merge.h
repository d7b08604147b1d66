// Several layered pictures of one camera as one: an object each, or a layer each of the same samples.
#pragma once

#include "ldi.h"

#include <string>
#include <vector>

namespace sparselens {

// Whether both have their samples at the same places, in the same order.
bool same_samples(const Ldi &a, const Ldi &b);

// Adds the channels of `layer`, which has the samples of `ldi`. A channel whose name is taken becomes one of the layer
// of that name; where that is taken too, the first stays.
void add_layer(Ldi &ldi, Ldi layer, const std::string &name);

// All samples of the parts, as tidy() takes them: pixel by pixel, those of the first part first. The display window is
// the first part's, the data window what holds all of theirs. A channel that a part does not have is 0
// there, but for coverage: without A its samples are opaque, without a coloured coverage it is that of A.
Ldi deep_merge(const std::vector<Ldi> &parts);

} // namespace sparselens
