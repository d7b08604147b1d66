// The data of the warp's kernels (kernels/warp_layout.h): the samples of all views, the samples that fall into each pixel
// of the centre view, and the result.
//
// Arithmetic is in double precision and in the CPU's order, without fused multiply-add (`precise`), so that the samples
// equal those of src/warp bit for bit.

#define Real double
#include "kernels/surface.h"
#include "kernels/warp_layout.h"
#include "kernels/warp_rules.h"
#include "kernels/coc_rules.h"

layout(local_size_x = threads) in;

layout(binding = 0) readonly buffer FrameBuffer { Frame frame; };
layout(binding = 1) readonly buffer Views { View views[]; };
// [view][pixel]: first sample, and one after the last
layout(binding = 2) readonly buffer Begins { uint begins[]; };
layout(binding = 3) readonly buffer Depths { float depths[]; };   // [sample]
layout(binding = 4) readonly buffer Weights { float weights[]; }; // [sample]
layout(binding = 5) readonly buffer Values { uint values[]; };    // [channel][sample], bits
layout(binding = 6) readonly buffer Ids { uint ids[]; };          // [channel]: 1 for ids, which are copied
// [pixel]: see first_of(). Two entries follow: the number of all samples; and 1 if a pixel has more samples than
// frame.most_in_pixel, else 0.
layout(binding = 7) buffer Ends { uint ends[]; };
// samples in the pixels that they fell into: index, dx, dy, 1 / z (bits)
layout(binding = 8) buffer Landed { uvec4 landed[]; };
// of each of these: the view, and the surface of the pixel or `none`
layout(binding = 9) buffer Marks { uvec2 marks[]; };
// [surface of a pixel, by number]: the mean of 1 / z, later the coverage
layout(binding = 10) buffer Means { double means[]; };
layout(binding = 11) buffer Verdicts { uint verdicts[]; }; // [block]: photo_verdict()
layout(binding = 12) buffer Emitted { uint emitted[]; }; // [pixel]: how many samples, later where they begin
layout(binding = 13) buffer Results { uint results[]; }; // [z, dx, dy, weight, channels][sample], bits

uint item() { return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * threads + gl_LocalInvocationIndex; }
uint pixel_count() { return uint(frame.width * frame.height); }
ivec2 position_of(uint pixel) {
    return ivec2(frame.first_x + int(pixel) % frame.width, frame.first_y + int(pixel) / frame.width);
}
bool has_too_many() { return ends[pixel_count() + 1] != 0; } // in some pixel
bool has_rule(uint rule) { return (frame.rules & rule) != 0; }

// Where begins[] has a pixel of a view.
uint begin_at(View view, int x, int y) {
    return view.begins + uint((y - view.min_y) * (view.max_x - view.min_x + 1) + x - view.min_x);
}

// The samples that fell into a pixel are landed[first_of(pixel)] to landed[ends[pixel] - 1].
uint first_of(uint pixel) { return pixel == 0 ? 0 : ends[pixel - 1]; }

float value_of(uint sample_, uint channel) { return uintBitsToFloat(values[channel * frame.samples + sample_]); }
double alpha_of(uint sample_) { return frame.alpha == none ? 1.0lf : double(value_of(sample_, frame.alpha)); }
double x_of(uvec4 fallen) { return double(uintBitsToFloat(fallen.y)); }
double y_of(uvec4 fallen) { return double(uintBitsToFloat(fallen.z)); }
double inverse_z_of(uvec4 fallen) { return double(uintBitsToFloat(fallen.w)); }

// The weight of a sample in the mean of its surface.
double weight_of(uvec4 fallen) {
    precise const double weight = double(weights[fallen.x]) * nearness(x_of(fallen), y_of(fallen));
    return weight;
}

// One after the last sample of the surface that begins at `from`, of a pixel whose samples end at `end`.
uint surface_end(uint from, uint end) {
    uint to = from + 1;
    while (to < end && marks[to].y == marks[from].y) ++to;
    return to;
}
