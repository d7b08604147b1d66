#version 460
// The lens gather of a quarter of a tile: what src/dof/lens/lens_tile.h says, with the same sums in the same order.
//
// A work group takes the lens points one after the other. It finds the blocks that the lens point moves into its pixels,
// and of their samples the nearest opaque one in each cell, by the atomic maximum of their keys in shared memory. What that
// leaves empty shows cracks and fillers. Samples of partial coverage come in the order of their depth, `chunk` at a time:
// those of a chunk are counted, listed and sorted by the pixel that they fall in, and each pixel puts its own over each
// other. Every sum belongs to one thread, so that the order of the additions does not depend on who comes first.
//
// gl_WorkGroupID.x: the quarter of a tile. gl_WorkGroupID.y: the group of four channels.
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_GOOGLE_include_directive : require

#include "tile_data.glsl"

layout(local_size_x = threads) in;

#include "tile_opaque.glsl"
#include "tile_unseen.glsl"
#include "tile_partial.glsl"

// Light and unknown weight of a pixel so far.
struct Sum {
    vec4 light;
    float unknown;
};

// Adds what the lens point sees: a sample, or what is unknown (`none`), behind partial ones.
void add_seen(inout Sum sum, uint seen, Over over, uint group) {
    const vec4 behind = seen != none ? colours[group * sample_count + seen] : vec4(0);
    precise vec4 light = sum.light;
    precise float unknown = sum.unknown;
    if (seen != none) light = light + lens.weight * behind;
    else unknown = unknown + lens.weight;
    if (over.transmittance < 1) {
        precise const float hidden = 1 - over.transmittance;
        precise vec4 in_front = over.colour;
        if (seen != none) in_front = in_front - hidden * behind;
        else unknown = unknown - lens.weight * hidden;
        light = light + lens.weight * in_front;
    }
    sum = Sum(light, unknown);
}

void main() {
    const uint t = first_tile + gl_WorkGroupID.x / 4, quarter = gl_WorkGroupID.x % 4, group = gl_WorkGroupID.y;
    const Tile tile = tiles[t];
    corner = ivec2(quarter % 2, quarter / 2) * size;
    first = vec2(tile.x, tile.y);
    Sum sum[own];
    for (uint j = 0; j < own; ++j) sum[j] = Sum(vec4(0), 0);
    precise float total = 0;
    for (uint k = 0; k < tile.lens_count; ++k) {
        lens = lens_points[tile.lens + k];
        total = total + lens.weight;
        const uint seen[own] = see_behind(tile);
        const Over over[own] = see_partial(tile, group);
        for (uint j = 0; j < own; ++j) add_seen(sum[j], seen[j], over[j], group);
        barrier();
    }
    const uint tile_pixels = 4 * pixels;
    for (uint j = 0; j < own; ++j) {
        const ivec2 at = pixel_of(j) + corner;
        const uint to = t * tile_pixels + at.y * 2 * size + at.x;
        sums[group * tile_count * tile_pixels + to] = sum[j].light;
        precise const float known = total - sum[j].unknown;
        if (group == 0) knowns[to] = known > 1e-6 * total ? known : 0;
    }
}
