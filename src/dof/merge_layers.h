// Merges layers of a deep picture, before the gather, if no blur tells them apart: cluster_for_gather() of
// deep/cluster.h.
#pragma once

#include "../deep/ldi.h"

namespace sparselens {

inline constexpr double layer_tolerance_px = 0.25;

// Whether the samples can be merged. Cryptomattes cannot, because a sample holds few ids, nor can samples without
// coverage, or with a coverage that differs by channel.
bool can_merge_layers(const Ldi &ldi);

// `scale` is R F, pixels times scene units. Volumes get one depth first (below). The result has no weights, because the
// lens gather ignores them. An LDI that cannot be merged is returned unchanged.
Ldi merge_layers(Ldi ldi, double scale, double tolerance);

// Gives each volume of a deep picture (smoke and fog, whose samples reach from z to z_back) one depth for the gather.
//
// A volume of even density absorbs light by the same share over each distance. Its light therefore comes from depths
// that follow an exponential distribution, which is cut off at the back of the volume. The mean is the middle of thin
// smoke, and nearly the front of dense smoke.

// The mean of that distribution, as a share of the volume's extent: 0.5 without coverage, 0 for coverage 1.
double shown_depth(double alpha);

// Moves each volume to its mean depth, and its image in a mirror as far; its end is then infinite. A volume without an
// end is always gathered at its z, so those of the file stay. Volumes do not overlap, so samples keep their order.
Ldi at_shown_depths(Ldi ldi);

} // namespace sparselens
