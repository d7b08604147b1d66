#version 460
// Replaces each number by the sum of those before it. A work group takes a chunk of the numbers. The first run finds
// the sum of each chunk. In the second run, each group adds the sums of the chunks before its own.

#extension GL_GOOGLE_include_directive : require
#include "kernels/warp_layout.h"

layout(local_size_x = threads) in;
layout(binding = 0) buffer Values { uint values[]; };
layout(binding = 1) buffer Totals { uint totals[]; }; // [chunk]
layout(push_constant) uniform Push { uint count, run; };

shared uint sums[threads];

// Returns the sum of the values of the threads before this one, and sets `all` to the sum of all. Ends with a barrier.
uint sum_before(uint value, out uint all) {
    const uint thread = gl_LocalInvocationIndex;
    sums[thread] = value;
    for (uint step_ = 1; step_ < threads; step_ *= 2) {
        barrier();
        const uint more = thread >= step_ ? sums[thread - step_] : 0;
        barrier();
        sums[thread] += more;
    }
    barrier();
    all = sums[threads - 1];
    const uint before = sums[thread] - value;
    barrier();
    return before;
}

void main() {
    const uint chunk = gl_WorkGroupID.x,
               first = (chunk * threads + gl_LocalInvocationIndex) * summed_at_once, end = min(first + summed_at_once, count);
    uint sum = 0, of_chunk, earlier = 0, of_earlier;
    for (uint n = first; n < end; ++n) sum += values[n];
    uint at = sum_before(sum, of_chunk);
    if (run == 0) {
        if (gl_LocalInvocationIndex == 0) totals[chunk] = of_chunk;
        return;
    }
    for (uint c = gl_LocalInvocationIndex; c < chunk; c += threads) earlier += totals[c];
    sum_before(earlier, of_earlier);
    at += of_earlier;
    for (uint n = first; n < end; ++n) {
        const uint value = values[n];
        values[n] = at;
        at += value;
    }
}
