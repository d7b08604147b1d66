#version 460
// Finds which samples of a pixel show one surface, like find_surfaces() of src/warp/surfaces.cpp; one thread per pixel.
// The samples are first sorted by depth, view and number, so that the order in which they came does not matter. In the
// end they lie surface by surface, front to back. Samples that do not belong to the pixel come last and belong to no
// surface.
#extension GL_GOOGLE_include_directive : require
#include "warp_data.glsl"

// Samples are numbered view by view.
bool nearer(uvec4 a, uvec4 b) {
    const float near = uintBitsToFloat(a.w), far = uintBitsToFloat(b.w);
    return near != far ? near > far : a.x < b.x;
}

bool one_surface(uint a, uint b) {
    return is_one_surface(inverse_z_of(landed[a]), inverse_z_of(landed[b]), frame.tolerance);
}

// Returns the first sample that belongs to the pixel.
uint behind_centre(uint pixel, uint first, uint end) {
    uint centre = first;
    while (centre < end && marks[centre].x != 0) ++centre;
    if (centre == end) {
        const View view = views[0];
        const ivec2 at = position_of(pixel);
        const bool inside = at.x >= view.min_x && at.x <= view.max_x && at.y >= view.min_y && at.y <= view.max_y;
        return inside ? end : first;
    }
    uint from = first;
    while (from < centre && !one_surface(from, centre)) ++from;
    return from;
}

// Numbers all samples of the anchor's surface that have no surface yet, and finds the mean of their 1 / z.
void claim(uint anchor, uint number, uint first, uint from, uint end) {
    precise double sum = 0, total = 0;
    for (uint i = from; i < end; ++i) {
        if (marks[i].y != none || !one_surface(i, anchor)) continue;
        marks[i].y = number;
        const double weight = weight_of(landed[i]);
        sum = sum + weight * inverse_z_of(landed[i]);
        total = total + weight;
    }
    precise const double mean = sum / total;
    means[first + number] = mean;
}

// The centre's samples determine surfaces first, before any other samples.
void claim_all(uint first, uint from, uint end) {
    uint number = 0;
    for (uint pass = 0; pass < 2; ++pass)
        for (uint i = from; i < end; ++i)
            if (marks[i].y == none && (marks[i].x == 0) == (pass == 0)) claim(i, number++, first, from, end);
}

// Orders front to back, and by view within a surface.
bool before(uvec2 a, uvec2 b, uint first) {
    if (a.y == b.y) return a.x < b.x;
    if (a.y == none || b.y == none) return b.y == none;
    const double near = means[first + a.y], far = means[first + b.y];
    return near != far ? near > far : a.y < b.y;
}

// Sorts by surface, or by depth.
void sort(uint first, uint end, bool by_surface) {
    for (uint i = first + 1; i < end; ++i) {
        const uvec4 fallen = landed[i];
        const uvec2 mark = marks[i];
        uint at = i;
        for (; at > first && (by_surface ? before(mark, marks[at - 1], first) : nearer(fallen, landed[at - 1])); --at) {
            landed[at] = landed[at - 1];
            marks[at] = marks[at - 1];
        }
        landed[at] = fallen;
        marks[at] = mark;
    }
}

void main() {
    const uint pixel = item();
    if (pixel >= pixel_count() || has_too_many()) return;
    const uint first = first_of(pixel), end = ends[pixel];
    if (first == end) return;
    sort(first, end, false);
    claim_all(first, behind_centre(pixel, first, end), end);
    sort(first, end, true);
}
