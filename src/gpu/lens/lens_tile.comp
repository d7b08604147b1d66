#version 460
// The lens gather of a quarter of a tile: as src/dof/lens/lens_gather.cpp does it.
//
// A work group takes the lens points a few at a time, which lie near each other on the lens. It finds the blocks that
// these move into its pixels, and the nearest opaque sample or facet of them in each cell, by the atomic maximum of
// their words in shared memory. Cells that stay empty show cracks and fillers. Samples of partial coverage come in order
// of depth, `chunk` at a time: those of a chunk are chained up and sorted for the thread that owns their pixel, which
// composites them. Every sum belongs to one thread, so the order of additions does not depend on the order in
// which threads run.
//
// Work that takes long is cut into passes of some lens points each; between passes the sums are kept in a buffer.
//
// gl_WorkGroupID.x: the quarter of a tile. gl_WorkGroupID.y: the group of four channels.
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require

#define Real float
#include "kernels/surface.h"
#include "kernels/lens_rules.h"
#include "tile_data.glsl"
#include "tile_seen.glsl"
#include "tile_sums.glsl"
#include "tile_partial.glsl"

uint place_of(uint t, uint group, uint j) {
    const ivec2 at = pixel_of(j) + corner;
    return (group * push.tile_count + t) * 4 * pixels + at.y * 2 * size + at.x;
}

void write_pixel(uint to, Sum sum, float total) {
    const vec4 known = known_of(sum, total);
    vec4 value = vec4(0);
    for (uint k = 0; k < 4; ++k)
        if (known[k] > 0) value[k] = sum.light[k] / known[k];
    values[to] = value;
    knowns[to] = any(greaterThan(known, vec4(0))) ? 1 : 0;
}

void main() {
    const uint t = gl_WorkGroupID.x / 4, quarter = gl_WorkGroupID.x % 4, group = gl_WorkGroupID.y;
    const Tile tile = tiles[t];
    corner = ivec2(quarter % 2, quarter / 2) * size;
    first = vec2(tile.x, tile.y);
    partial_first = tile.partial[quarter];
    partial_count = tile.partial_count[quarter];
    held_out = tile.holdout;
    units = tile.units;
    number_bits = tile.number_bits;
    runs = tile.runs;
    run_count = tile.run_count;
    numbers = tile.numbers;
    const uint begin = push.pass * tile.lens_in_pass, end = min(begin + tile.lens_in_pass, tile.lens_count);
    if (begin >= end || max(corner.x, corner.y) >= tile.size) return; // nothing is asked for
    [[dont_unroll]] for (uint j = 0; j < own; ++j) {
        const uint from = 2 * place_of(t, group, j);
        sum[j] = Sum(vec4(0), vec4(0));
        if (push.pass > 0) sum[j] = Sum(sums[from], sums[from + 1]);
    }
    for (uint k = begin; k < end; k += points) {
        first_lens = tile.lens + k;
        first_column = tile.columns + k * size;
        for (uint l = 0; l < points; ++l) {
            const Lens p = lens_points[first_lens + l];
            eyes[l] = vec4(p.x, p.y, p.pixel_x, p.pixel_y);
            whole_eyes[l] = ivec4(whole_lens(p.x, units.lens_unit), whole_lens(p.y, units.lens_unit),
                                  whole_shift(p.pixel_x, units.unit, units.farthest),
                                  whole_shift(p.pixel_y, units.unit, units.farthest));
            weights[l] = p.weight;
        }
        if (is_weighted) weigh_channels(group);
        see_behind(tile);
        add_behind(group);
        if ((rules & with_partial) != 0) add_partial(group);
        barrier();
    }
    [[dont_unroll]] for (uint j = 0; j < own; ++j) {
        const uint to = place_of(t, group, j);
        if (end == tile.lens_count) {
            write_pixel(to, sum[j], tile.weight);
        } else {
            sums[2 * to] = sum[j].light;
            sums[2 * to + 1] = sum[j].weight;
        }
    }
}
