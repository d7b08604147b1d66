// Merges layers of a deep picture, before the gather, if no blur tells them apart.
//
// Consecutive samples of a pixel become one sample if their perceptive depths R F / z (pixels, which differ as their
// CoCs do) and their positions all lie within a tolerance. The last of them may be opaque, the others have partial
// coverage. They are composited by `over`, so that the flattened picture does not change. Depth (as 1 / z) and position
// become means, weighted by what each sample shows. No CoC or coordinate changes by more than the tolerance, or by half
// of it if the samples are equal.
#pragma once

#include "../deep/ldi.h"

namespace sparselens {

inline constexpr double layer_tolerance_px = 0.25;

// Whether the samples can be merged. Cryptomattes cannot, because a sample holds few ids, nor can samples whose
// coverage differs by channel.
bool can_merge_layers(const Ldi &ldi);

// `scale` is R F, pixels times scene units. Volumes get one depth first (volumes.h). The result has no extents and no
// weights, because the lens gather ignores them. Ids are those of the front samples. An LDI that cannot be merged is
// returned unchanged. The LDI must be tidy.
Ldi merge_layers(const Ldi &ldi, double scale, double tolerance);

// The same with less memory: the samples of `ldi` are freed as those of the result are made.
Ldi merge_layers(Ldi &&ldi, double scale, double tolerance);

} // namespace sparselens
