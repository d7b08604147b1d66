// How much light a holdout that stays sharp lets through (deep/holdout.h).

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
