#version 460
// Counts the final samples of a pixel, one thread per pixel: one for each surface, except surfaces that the vote of the
// views rejects (src/warp/coverage.cpp). means[] holds coverages from then on.
#extension GL_GOOGLE_include_directive : require
#include "warp_data.glsl"
#include "warp_merge.glsl"

double there, past, through;

// Counts the votes of one pixel of a view, which has these samples.
void count_votes(uint begin, uint end, double inverse_z) {
    if (begin == end) return;
    precise double left = 1, seen = 0, missed = past;
    for (uint i = begin; i < end; ++i) {
        const double covered = covers(alpha_of(i), left);
        precise const double nearer = 1.0lf / double(depths[i]) - inverse_z;
        if (abs(nearer) < frame.tolerance) seen = seen + covered;
        else if (nearer < 0) missed = missed + covered;
        left = left - covered;
    }
    missed = missed + left;
    if (seen > 0) through = through + left;
    there = there + seen;
    past = missed;
}

void ask(View view, double x, double y, double inverse_z) {
    double seen_x, seen_y;
    if (!in_view(view, x, y, inverse_z, seen_x, seen_y) || !lies_in(view, seen_x, seen_y)) return;
    const uint at = begin_at(view, seen_x, seen_y);
    count_votes(begins[at], begins[at + 1], inverse_z);
}

double vote(ivec2 pixel, Mean mean) {
    precise const double x = double(pixel.x) + 0.5lf + mean.dx, y = double(pixel.y) + 0.5lf + mean.dy;
    there = 0;
    past = 0;
    through = 0;
    for (uint v = 1; v < frame.views; ++v) ask(views[v], x, y, mean.inverse_z);
    return coverage_by_votes(there, past, through, mean.covers);
}

void main() {
    const uint pixel = item();
    if (pixel >= pixel_count()) return;
    const uint first = first_of(pixel), end = ends[pixel];
    uint count = 0;
    for (uint from = first, to; from < end && marks[from].y != none; from = to) {
        to = surface_end(from, end);
        const bool sure = marks[from].x == 0 || stays_alone(pixel, from);
        const double coverage = sure ? 1.0lf : vote(position_of(pixel), mean_of(from, to, dvec2(0)));
        means[first + marks[from].y] = coverage;
        if (coverage != 0) ++count;
    }
    emitted[pixel] = count;
}
