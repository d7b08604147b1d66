// Merges layers of a deep picture, before the gather, if no blur tells them apart.
//
// Consecutive samples of a pixel become one sample if their disparities R F / z (pixels, which differ as their
// CoCs do) and their positions all lie within a tolerance. The last of them may be opaque, the others have partial
// coverage. They are composited by `over`, so that the flattened picture does not change. Depth (as 1 / z) and position
// become means, weighted by what each sample shows. No CoC or coordinate changes by more than the tolerance, or by half
// of it if two samples show equally much.
#pragma once

#include "../deep/ldi.h"

namespace sparselens {

inline constexpr double layer_tolerance_px = 0.25;

// Whether the samples can be merged. Cryptomattes cannot, because a sample holds few ids, nor can samples without
// coverage, or with a coverage that differs by channel.
bool can_merge_layers(const Ldi &ldi);

// `scale` is R F, pixels times scene units. Volumes get one depth first (below). The result has no weights, because the
// lens gather ignores them. Ids are those of the front samples. An LDI that cannot be merged is returned unchanged.
Ldi merge_layers(const Ldi &ldi, double scale, double tolerance);

// The same with less memory: the samples of `ldi` are freed as those of the result are made.
Ldi merge_layers(Ldi &&ldi, double scale, double tolerance);

// Gives each volume of a deep picture (smoke and fog, whose samples reach from z to z_back) one depth for the gather.
//
// A volume of even density absorbs light by the same share over each distance. Its light therefore comes from depths
// that follow an exponential distribution, which is cut off at the back of the volume. The mean is the middle of thin
// smoke, and nearly the front of dense smoke.

// The mean of that distribution, as a share of the volume's extent: 0.5 without coverage, 0 for coverage 1.
double shown_depth(double alpha);

// Moves each volume to its mean depth, and its image in a mirror as far. An infinite z_back then marks it as a volume
// that has its depth; volumes that never end stay where they are. Volumes do not overlap, so samples keep their order.
Ldi at_shown_depths(Ldi ldi);

} // namespace sparselens
