#version 460
// The prefix sum of a block of numbers: each number becomes the sum of those before it in the block, and sums[] gets
// the sum of the block. (G. E. Blelloch, "Prefix sums and their applications", 1990, block by block.)
#extension GL_GOOGLE_include_directive : require
#include "kernels/warp_layout.h"

layout(local_size_x = threads) in;

layout(binding = 0) buffer Numbers { uint numbers[]; };
layout(binding = 1) writeonly buffer Sums { uint sums[]; };
layout(push_constant) uniform Push { uint count; };

shared uint sum_up_to[threads];

void main() {
    const uint block = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x, me = gl_LocalInvocationIndex;
    const uint first = (block * threads + me) * scanned;
    if (block * threads * scanned >= count) return;
    uint mine[scanned], sum = 0;
    for (uint i = 0; i < scanned; ++i) {
        mine[i] = first + i < count ? numbers[first + i] : 0;
        sum += mine[i];
    }
    sum_up_to[me] = sum;
    for (uint step_ = 1; step_ < threads; step_ *= 2) {
        barrier();
        const uint before = me >= step_ ? sum_up_to[me - step_] : 0;
        barrier();
        sum_up_to[me] += before;
    }
    if (me == threads - 1) sums[block] = sum_up_to[me];
    uint before = sum_up_to[me] - sum;
    for (uint i = 0; i < scanned && first + i < count; ++i) {
        numbers[first + i] = before;
        before += mine[i];
    }
}
