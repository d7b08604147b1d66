#version 460
// The lens gather of a quarter of a tile: the same as src/dof/lens/lens_gather.cpp, with the same sums in the same order.
//
// A work group takes the lens points one after the other. It finds the blocks that the lens point moves into its
// pixels, and the nearest opaque sample or facet of these in each cell, by the atomic maximum of their keys in shared
// memory. Cells that stay empty show cracks and fillers. Samples of partial coverage come in order of depth, `chunk` at
// a time: the samples of a chunk are counted, listed and sorted by the pixel that they fall in, and each pixel
// composites its own. Every sum belongs to one thread, so the order of additions does not depend on the order in which
// threads run.
//
// Work that takes long is cut into passes of some lens points each; between passes the sums are kept in a buffer.
//
// gl_WorkGroupID.x: the quarter of a tile. gl_WorkGroupID.y: the group of four channels.
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_GOOGLE_include_directive : require

#define Real float
#include "kernels/surface.h"
#include "kernels/lens_rules.h"
#include "tile_data.glsl"

layout(local_size_x = threads) in;

#include "tile_seen.glsl"
#include "tile_partial.glsl"
#include "tile_sums.glsl"

uint place_of(uint t, uint group, ivec2 at) { return (group * push.tile_count + t) * 4 * pixels + at.y * 2 * size + at.x; }

void write_pixel(uint to, Sum sum, float total) {
    const vec4 known = known_of(sum, total);
    precise vec4 value = vec4(0);
    for (uint k = 0; k < 4; ++k)
        if (known[k] > 0) value[k] = sum.light[k] / known[k];
    values[to] = value;
    knowns[to] = any(greaterThan(known, vec4(0))) ? 1 : 0;
}

void main() {
    const uint t = push.first_tile + gl_WorkGroupID.x / 4, quarter = gl_WorkGroupID.x % 4, group = gl_WorkGroupID.y;
    const Tile tile = tiles[t];
    corner = ivec2(quarter % 2, quarter / 2) * size;
    first = vec2(tile.x, tile.y);
    rules = tile.rules;
    partial_first = tile.partial[quarter];
    partial_count = tile.partial_count[quarter];
    held_out = tile.holdout;
    const uint begin = push.pass * tile.lens_in_pass, end = min(begin + tile.lens_in_pass, tile.lens_count);
    if (begin >= end) return; // nothing is left to do
    Sum sum[own];
    for (uint j = 0; j < own; ++j) {
        const uint from = 2 * place_of(t, group, pixel_of(j) + corner);
        sum[j] = Sum(vec4(0), vec4(0));
        if (push.pass > 0) sum[j] = Sum(sums[from], sums[from + 1]);
    }
    for (uint k = begin; k < end; ++k) {
        lens = lens_points[tile.lens + k];
        const uint seen[own] = see_behind(tile);
        const Over over[own] = see_partial(group);
        for (uint j = 0; j < own; ++j) {
            const float passed = opaque_passes(j, seen[j]);
            if ((rules & weighted) == 0) add_seen(sum[j], seen[j], passed, over[j], group);
            else if (seen_through(tile, k, pixel_of(j) + corner)) add_seen_weighted(sum[j], seen[j], passed, over[j], group);
        }
        barrier();
    }
    // the sum over all lens points in the last pass
    precise const float total = lens.weight_before + lens.weight;
    for (uint j = 0; j < own; ++j) {
        const uint to = place_of(t, group, pixel_of(j) + corner);
        if (end == tile.lens_count) {
            write_pixel(to, sum[j], total);
        } else {
            sums[2 * to] = sum[j].light;
            sums[2 * to + 1] = sum[j].weight;
        }
    }
}
