#version 460
// The selective gather of a tile: the same as src/dof/selective/selective.cpp, with the same sums in the same order.
//
// A work group takes the pieces that its tile lists (selective_tiles.cpp), front to back. If the discs of a block cover the
// tile, it adds the sums of the block to all pixels. It loads the splats of other blocks into shared memory, chunk by
// chunk, with the chords of each disc along the edges of the tile's columns and rows. Then each thread adds the light
// of these discs to its pixels, splat after splat. At the end of a bin, the sums become a layer of each pixel, or part
// of a layer.
// Every sum belongs to one thread.
//
// Work that takes long is cut into passes: all state of a thread goes to buffers at the end of a pass and comes back at
// the beginning of the next one. The last pass blends.
//
// gl_WorkGroupID.x: the tile. gl_WorkGroupID.y: the group of four colours.
#extension GL_GOOGLE_include_directive : require

#define Real double

// The arc sine for 0 <= x <= 1, because GLSL has none for double. The rational form of Sun's fdlibm; the error is below
// 1e-15.
double asin(double x) {
    const bool small = x < 0.5lf;
    precise const double t = small ? x * x : (1 - x) * 0.5lf;
    precise const double above =
        t * (1.66666666666666657415e-01lf +
             t * (-3.25565818622400915405e-01lf +
                  t * (2.01212532134862925881e-01lf +
                       t * (-4.00555345006794114027e-02lf +
                            t * (7.91534994289814532176e-04lf + t * 3.47933107596021167570e-05lf)))));
    precise const double below =
        1 + t * (-2.40339491173441421878e+00lf +
                 t * (2.02094576023350569471e+00lf +
                      t * (-6.88283971605453293030e-01lf + t * 7.70381505559019352791e-02lf)));
    const double s = small ? x : sqrt(t);
    precise const double bent = s + s * (above / below);
    precise const double angle = small ? bent : 3.141592653589793lf / 2 - 2 * bent;
    return angle;
}

#include "kernels/psf_rules.h"
#include "kernels/layer_rules.h"
#include "splat_data.glsl"

layout(local_size_x = threads) in;

#include "splat_layers.glsl"

uint running_at(uint sum) { return place * (bin_sums * pixels + bin_sums) + sum * pixels; }

Bin bin_from(uint at, uint step_) {
    return Bin(running[at], running[at + step_], running[at + 2 * step_],
               dvec4(running[at + 3 * step_], running[at + 4 * step_], running[at + 5 * step_], running[at + 6 * step_]));
}

void keep_bin(uint at, uint step_, Bin bin) {
    running[at] = bin.coverage;
    running[at + step_] = bin.known;
    running[at + 2 * step_] = bin.radius;
    for (int k = 0; k < 4; ++k) running[at + (3 + k) * step_] = bin.light[k];
}

void begin_pass() {
    uniform_ = push.pass == 0 ? no_sums() : bin_from(running_at(bin_sums), 1);
    for (uint j = 0; j < own; ++j) {
        const uint state = place * 2 * pixels + pixel_of(j);
        bins[j] = push.pass == 0 ? no_sums() : bin_from(running_at(0) + pixel_of(j), pixels);
        layer_count[j] = push.pass == 0 ? 0 : states[state];
        last_bin[j] = push.pass == 0 ? 0 : states[state + pixels];
    }
}

void end_pass() {
    barrier(); // all threads have read what they began with
    if (thread() == 0) keep_bin(running_at(bin_sums), 1, uniform_);
    for (uint j = 0; j < own; ++j) {
        const uint state = place * 2 * pixels + pixel_of(j);
        keep_bin(running_at(0) + pixel_of(j), pixels, bins[j]);
        states[state] = layer_count[j];
        states[state + pixels] = last_bin[j];
    }
}

void add_uniform(uint block) {
    const uint at = block * value_size;
    dvec4 more = dvec4(0);
    for (uint k = 0; k < 4; ++k)
        if (has_colour(k)) more[k] = sums[at + colour_at(k)];
    precise const double coverage = uniform_.coverage + sums[at], known = uniform_.known + sums[at + 1],
                         radius = uniform_.radius + sums[at + value_size - 1];
    precise const dvec4 light = uniform_.light + more;
    uniform_ = Bin(coverage, known, radius, light);
}

// The splats of the chunk that touch the strip of pixel j, one bit each.
uint touching_pixel(uint j) {
    const uint strip = pixel_of(j) / strip_size;
    return touching[2 * strip] | touching[2 * strip + 1];
}

void add_splat(uint s, uint j) {
    const ivec2 at = position_of(j) + ivec2(tile.x_min, tile.y_min);
    if (at.x < touched[s].z || at.x >= touched[s].w) return;
    const double weight = weight_of(s, at.x, at.y);
    precise const double coverage = bins[j].coverage + weight * share[s].x, known = bins[j].known + weight * share[s].y,
                         radius = bins[j].radius + weight * share[s].z;
    precise const dvec4 light = bins[j].light + weight * dvec4(colour[s]);
    bins[j] = Bin(coverage, known, radius, light);
}

void main() {
    const uint t = gl_WorkGroupID.x;
    group = gl_WorkGroupID.y;
    place = t * gl_NumWorkGroups.y + group;
    tile = tiles[t];
    begin_pass();
    const uint end = cuts[t * (push.passes + 1) + push.pass + 1];
    for (uint n = cuts[t * (push.passes + 1) + push.pass]; n < end; ++n) {
        const uint visit = lists[n];
        const Piece piece = pieces[visit >> 2];
        if ((visit & covers) != 0) add_uniform(piece.block);
        for (uint begin = piece.begin; (visit & covers) == 0 && begin < piece.end; begin += chunk) {
            const uint count = min(chunk, piece.end - begin);
            load_chunk(begin, count);
            for (uint j = 0; j < own; ++j)
                for (uint left = touching_pixel(j); left != 0; left &= left - 1) add_splat(uint(findLSB(left)), j);
        }
        if ((visit & ends_bin) != 0) finish_bin(piece.bin);
    }
    if (push.pass + 1 < push.passes) {
        end_pass();
        return;
    }
    for (uint j = 0; j < own; ++j) blend(j, t);
}
