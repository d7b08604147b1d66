// Layers of a deep picture that no blur tells apart, merged before the gather.
//
// Samples that follow each other in a pixel become one sample where their perceptive depths R F / z (pixels, which differ
// as their CoCs do) and their positions all lie within a tolerance. The last of them may be opaque, the others are
// of partial coverage. They are composited by `over`, so that the flattened picture does not change; depth (as 1 / z) and
// position become means, weighted by what each sample shows. No CoC and no coordinate changes by more than the tolerance,
// and by half of it where the samples are even.
#pragma once

#include "../deep/ldi.h"

namespace sparselens {

inline constexpr double layer_tolerance_px = 0.25;

// Whether the samples can be merged as they are: not those of Cryptomattes, which know few ids a sample, nor those whose
// coverage differs by channel. The light of one coverage alone can be.
bool can_merge_layers(const Ldi &ldi);

// `scale` is R F, pixels times scene units. The result has no extents and no weights, of which the lens gather knows
// nothing. Ids are the front samples'. An LDI that cannot be merged is returned as it is. The LDI is tidy.
Ldi merge_layers(const Ldi &ldi, double scale, double tolerance);

// The same with less memory: the samples of `ldi` are freed as those of the result are made.
Ldi merge_layers(Ldi &&ldi, double scale, double tolerance);

} // namespace sparselens
