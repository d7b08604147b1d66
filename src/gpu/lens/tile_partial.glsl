// How much light a holdout that stays sharp lets through (deep/merge.h).

float part_of(uint part, uint k) { return uintBitsToFloat(holdouts[held_out + 4 * pixels + 1 + 3 * part + k]); }

// The share of light from a perceptive depth that passes at the thread's pixel `j`.
float passes(uint j, float depth) {
    if ((rules & holdout) == 0) return 1;
    const ivec2 at = pixel_of(j) + corner;
    const uint pixel = held_out + at.y * 2 * size + at.x, end = holdouts[pixel + 1];
    const float farthest = 3e38, z = depth > 0 ? min(push.depth_at_1 / depth, farthest) : farthest;
    float passed = 1;
    for (uint part = holdouts[pixel]; part < end && passed > 0; ++part) {
        const float begins = part_of(part, 0), ends = part_of(part, 1), clear = part_of(part, 2);
        if (!is_held_out(begins, z)) break;
        passed *= passes_part(begins, ends, clear, z);
    }
    return passed;
}

// The same for the light of what see_behind() found there; 1 if that is unknown.
float opaque_passes(uint j, uint seen) {
    if ((rules & holdout) == 0 || seen == none) return 1;
    const uint64_t key = front[cell_of(pixel_of(j))];
    return passes(j, depth_of(uppers[key != 0UL ? sample_of(key) : seen]));
}

// Composites partial samples in front of the pixels, in order of depth.

// The partial samples in front of a pixel.
struct Over {
    // of samples behind focus and in front of it, if that makes a difference; else all count as behind
    vec4 colour, colour_in_front;
    float transmittance;
    float hidden_in_front; // how much the samples in front of focus hide
};

// `j`: the thread's pixel.
void add_over(inout Over over, uint j, uint sample_, uint group) {
    const bool in_front = (rules & two_sided) != 0 && cocs[sample_] < 0;
    precise vec4 colour = in_front ? over.colour_in_front : over.colour;
    precise const float share = over.transmittance * passes(j, depth_of(uppers[sample_]));
    colour = colour + share * colours[group * push.sample_count + sample_];
    const float passed = left_behind(over.transmittance, 1 - alphas[sample_]);
    precise float hidden = over.hidden_in_front;
    if (in_front) hidden = hidden + (over.transmittance - passed);
    over = Over(in_front ? over.colour : colour, in_front ? colour : over.colour_in_front, passed, hidden);
}

// Counts the samples of a chunk by pixel, and returns the pixels of the thread's two samples; -1: hidden or outside.
int[2] count_chunk(uint begin) {
    int at[2];
    for (uint h = 0; h < 2; ++h) {
        at[h] = -1;
        const uint n = begin + thread() + threads * h;
        if (n >= partial_count) continue;
        const uint i = partial_lists[partial_first + n];
        const ivec2 pixel = seen_at(i, cocs[i]);
        if (pixel.x < 0 || pixel.y < 0 || pixel.x >= size || pixel.y >= size) continue;
        if (key_of(uppers[i], i) < front[cell_of(pixel)]) continue;
        at[h] = pixel.y * size + pixel.x;
        atomicAdd(counts[at[h]], 1);
        listed_count = 1; // all threads write the same
    }
    return at;
}

void sort_list(uint begin, uint end) {
    for (uint i = begin + 1; i < end; ++i) {
        const uint moved = listed[i];
        uint to = i;
        for (; to > begin && listed[to - 1] > moved; --to) listed[to] = listed[to - 1];
        listed[to] = moved;
    }
}

// Lists the samples of a chunk by pixel, front to back in each pixel. Returns false if there are none. The samples of
// the thread's pixel j are [start[j], counts[its pixel]) of listed[]. Ends with a barrier.
bool list_chunk(uint begin, out uint start[own]) {
    for (uint j = 0; j < own; ++j) counts[thread() + threads * j] = 0;
    if (thread() == 0) listed_count = 0;
    barrier();
    const int at[2] = count_chunk(begin);
    barrier();
    const bool any = listed_count != 0;
    barrier();
    if (!any) return false;
    if (thread() == 0) listed_count = 0;
    barrier();
    for (uint j = 0; j < own; ++j) {
        const uint pixel = thread() + threads * j, count = counts[pixel];
        start[j] = count > 0 ? atomicAdd(listed_count, count) : 0;
        counts[pixel] = start[j];
    }
    barrier();
    for (uint h = 0; h < 2; ++h)
        if (at[h] >= 0) listed[atomicAdd(counts[at[h]], 1)] = thread() + threads * h;
    barrier();
    for (uint j = 0; j < own; ++j) sort_list(start[j], counts[thread() + threads * j]);
    return true;
}

Over[own] see_partial(uint group) {
    Over over[own];
    for (uint j = 0; j < own; ++j) over[j] = Over(vec4(0), vec4(0), 1, 0);
    for (uint begin = 0; begin < partial_count; begin += chunk) {
        uint start[own];
        if (!list_chunk(begin, start)) continue;
        for (uint j = 0; j < own; ++j)
            for (uint n = start[j]; n < counts[thread() + threads * j]; ++n)
                add_over(over[j], j, partial_lists[partial_first + begin + listed[n]], group);
        barrier();
    }
    return over;
}
