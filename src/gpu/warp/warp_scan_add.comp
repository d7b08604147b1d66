#version 460
// Adds to each number of a block (warp_scan.comp) the sum of the blocks before it.
#extension GL_GOOGLE_include_directive : require
#include "kernels/warp_layout.h"

layout(local_size_x = threads) in;

layout(binding = 0) buffer Numbers { uint numbers[]; };
layout(binding = 1) readonly buffer Sums { uint sums[]; }; // of the blocks before
layout(push_constant) uniform Push { uint count; };

void main() {
    const uint i = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * threads + gl_LocalInvocationIndex;
    if (i < count) numbers[i] += sums[i / scan_block];
}
