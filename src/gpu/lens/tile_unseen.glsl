// Finds what a lens point sees where it meets no opaque sample, or only one far behind: a surface through the cracks
// between its samples, else fillers.

// Returns the key of the sample that shows through a crack at a cell; 0: there is no crack.
uint64_t torn_at(uint cell) {
    const uint64_t behind = behind_crack(front[cell]);
    uint64_t farthest = 0UL;
    const uint steps[4] = {1, side, side - 1, side + 1};
    for (uint s = 0; s < 4; ++s) {
        const uint step = steps[s];
        const uint64_t one = front[cell - step], other = front[cell + step];
        if (one <= behind || other <= behind) continue;
        const vec2 apart = places[sample_of(one)] - places[sample_of(other)];
        const float depth_a = depth_of(uppers[sample_of(one)]), depth_b = depth_of(uppers[sample_of(other)]);
        if (!is_crack(apart.x, apart.y, depth_a, depth_b)) continue;
        const uint64_t farther = depth_a <= depth_b ? one : other;
        if (farthest == 0UL || depth_of(uppers[sample_of(farther)]) < depth_of(uppers[sample_of(farthest)])) farthest = farther;
    }
    return farthest;
}

// Whether something at this depth is behind what a cell shows, or behind a surface that is torn there.
bool hides(uint cell, float depth) {
    const uint64_t limit = hiding_key(depth);
    return front[cell] > limit || (front[cell - 1] > limit && front[cell + 1] > limit) ||
           (front[cell - side] > limit && front[cell + side] > limit);
}

// Returns what lies behind the partial samples in the thread's pixels: a sample, or `none` if it is unknown. Closes
// cracks in front[]. Ends with a barrier.
uint[own] see_behind(Tile tile) {
    if (thread() == 0) empty_count = 0;
    see_opaque(tile.blocks, tile.block_count, 0);
    see_facets(tile.facets, tile.facet_count);
    if (tile.solid_count > 0) see_solids(tile.solids, tile.solid_count);
    if ((rules & images) != 0) see_images(tile.blocks, tile.block_count);
    uint seen[own];
    uint64_t torn[own];
    bool any_empty = false;
    for (uint j = 0; j < own; ++j) {
        const uint cell = cell_of(pixel_of(j));
        const uint64_t key = front[cell];
        seen[j] = key == 0UL ? none : (rules & images) != 0 ? image_at(cell) : sample_of(key);
        torn[j] = torn_at(cell);
        any_empty = any_empty || key == 0UL;
    }
    if (any_empty) atomicAdd(empty_count, 1);
    barrier();
    if (empty_count != 0) see_opaque(tile.fillers, tile.filler_count, cells);
    for (uint j = 0; j < own; ++j) {
        const uint cell = cell_of(pixel_of(j));
        if (torn[j] != 0UL) seen[j] = sample_of(torn[j]);
        if (seen[j] != none) continue;
        const uint64_t filler = front[cells + cell];
        if (filler != 0UL && !hides(cell, depth_of(upper_of(filler)))) seen[j] = sample_of(filler);
    }
    barrier();
    for (uint j = 0; j < own; ++j)
        if (torn[j] != 0UL) front[cell_of(pixel_of(j))] = torn[j];
    barrier();
    return seen;
}
