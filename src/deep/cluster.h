// Reduces the samples of each pixel by disparity R F / z, so that the LDI can be refocused. Image depths count too.
//
// The samples of a cluster become one sample. They are composited, so that the flattened picture does not change: an
// opaque sample hides those behind it, which are dropped. (The warp has merged what several views show of one surface.)
// Depths (as 1 / z) and position become means, weighted by what each sample shows; a cluster with a volume becomes a
// volume. The CoC of no sample changes by more than the extent of its cluster, which is R F / z of its front minus
// R F / z of its back, or the range of R F / image_z if that is larger.
#pragma once

#include "../base/progress.h"
#include "ldi.h"

namespace sparselens {

struct ClusterOptions {
    double scale = 1;     // R F, pixels times scene units; with tolerance 0 any scale will do
    double tolerance = 0; // largest extent of a cluster, pixels of CoC; 0: only equal depths
    int layers = 0;       // most samples per pixel; 0: as many as the tolerance requires
};

struct Clustered {
    Ldi ldi;
    double largest_error = 0; // bound on the change of any sample's CoC, pixels (at `scale`)
};

Clustered cluster(const Ldi &ldi, const ClusterOptions &options, Progress &progress);

// The same in place, for the gather (dof/merge_layers.h), which sees behind what is opaque and moves samples by their
// positions:
// - An opaque sample ends its cluster, and the samples behind it stay.
// - Positions in a cluster differ by at most the tolerance, too.
// - Volumes count as points. A cluster of volumes alone stays a volume.
// Needs A, and coverage must not differ by channel.
Ldi cluster_for_gather(Ldi ldi, double scale, double tolerance);

} // namespace sparselens
