#version 460
// Reprojection: one thread takes a pixel of a view, and puts its samples into the pixels of the centre view that they
// fall into. The first run counts them, prefix sums then give each pixel its range, and the second run lists them. No
// thread waits for another; warp_surfaces.comp sorts the samples, whose order is arbitrary.
//
// gl_WorkGroupID.z: the view.
#extension GL_GOOGLE_include_directive : require
#include "warp_data.glsl"

layout(push_constant) uniform Push { uint list; }; // 0: count

void main() {
    const View view = views[gl_WorkGroupID.z];
    const int width = view.max_x - view.min_x + 1;
    const uint i = item();
    if (i >= uint(width * (view.max_y - view.min_y + 1))) return;
    const double from_x = double(view.min_x + int(i) % width) + 0.5lf,
                 from_y = double(view.min_y + int(i) / width) + 0.5lf;
    const double far_x = at_infinity(from_x, view.unzoom, view.offset_x), far_y = at_infinity(from_y, view.unzoom, view.offset_y),
                 parallax_x = parallax(from_x, view.step_x, view.approach),
                 parallax_y = parallax(from_y, view.step_y, view.approach);
    for (uint s = begins[view.begins + i]; s < begins[view.begins + i + 1]; ++s) {
        precise const double inverse_z = 1.0lf / double(depths[s]);
        precise const double x = far_x + parallax_x * inverse_z, y = far_y + parallax_y * inverse_z;
        const double cell_x = floor(x), cell_y = floor(y);
        if (!(cell_y >= double(frame.first_y) && cell_y < double(frame.first_y + frame.height))) continue;
        if (!(cell_x >= double(frame.first_x) && cell_x < double(frame.first_x + frame.width))) continue;
        const uint pixel = uint(int(cell_y) - frame.first_y) * uint(frame.width) + uint(int(cell_x) - frame.first_x);
        const uint at = atomicAdd(ends[pixel], 1);
        if (list == 0) {
            if (at >= frame.most_in_pixel) ends[pixel_count() + 1] = 1;
            continue;
        }
        precise const double dx = x - cell_x - 0.5lf, dy = y - cell_y - 0.5lf;
        landed[at] = uvec4(s, floatBitsToUint(float(dx)), floatBitsToUint(float(dy)), floatBitsToUint(float(inverse_z)));
        marks[at] = uvec2(gl_WorkGroupID.z, none);
    }
}
