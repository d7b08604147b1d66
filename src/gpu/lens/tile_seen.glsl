// Finds the nearest key in each cell that a lens point sees: of opaque samples, of facets between them (dof/facets) and
// of solids behind them (dof/lens/sample_blocks.h).

// Returns the pixel of the quarter, or next to it, in which the lens point sees a sample; outside: x < -1.
ivec2 seen_at(uint sample_, float coc) {
    const vec2 place = places[sample_];
    const float x = seen_along(place.x, first.x - 1, coc, lens.x, lens.pixel_x + shift_of_samples),
                y = seen_along(place.y, first.y - 1, coc, lens.y, lens.pixel_y + shift_of_samples);
    const ivec2 at = ivec2(int(cell_along(x, tile_stride - 1)), int(cell_along(y, tile_stride - 1))) - border - corner;
    const bool inside = all(greaterThanEqual(at, ivec2(-1))) && all(lessThanEqual(at, ivec2(size)));
    return inside ? at : ivec2(-2);
}

bool out_of_reach(Block b) {
    const vec2 a = b.coc_min * vec2(lens.x, lens.y), c = b.coc_max * vec2(lens.x, lens.y);
    const vec2 least = min(a, c), most = max(a, c), begin = first + vec2(corner) - 1 - vec2(lens.pixel_x, lens.pixel_y),
               end = begin + side;
    return b.x_max + most.x + 1 < begin.x || b.x_min + least.x - 1 > end.x || b.y_max + most.y + 1 < begin.y ||
           b.y_min + least.y - 1 > end.y;
}

// Lists the blocks that reach the quarter, out of up to `threads` blocks. Begins and ends with a barrier.
void find_near(uint list, uint count) {
    barrier();
    if (thread() == 0) near_count = 0;
    barrier();
    if (thread() < count) {
        const uint b = block_lists[list + thread()];
        if (!out_of_reach(blocks[b])) near_blocks[atomicAdd(near_count, 1)] = b;
    }
    barrier();
}

// Finds the nearest opaque samples of listed blocks, into front[offset + cell]. Ends with a barrier.
void see_opaque(uint list, uint count, uint offset) {
    for (uint c = thread(); c < cells; c += threads) front[offset + c] = 0UL;
    for (uint begin = 0; begin < count; begin += threads) {
        find_near(list + begin, count - begin);
        for (uint n = thread() / 32; n < near_count; n += threads / 32) {
            const Block b = blocks[near_blocks[n]];
            for (uint i = b.begin + thread() % 32; i < b.opaque_end; i += 32) {
                const ivec2 at = seen_at(i, cocs[i]);
                if (at.x >= -1) atomicMax(front[offset + cell_of(at)], key_of(uppers[i], i));
            }
        }
    }
    barrier();
}

// Solids hide what lies behind them, in cells that show something. Ends with a barrier.
void see_solids(uint list, uint count) {
    for (uint begin = 0; begin < count; begin += threads) {
        find_near(list + begin, count - begin);
        for (uint n = thread() / 32; n < near_count; n += threads / 32) {
            const Block b = blocks[near_blocks[n]];
            for (uint i = b.begin + thread() % 32; i < b.opaque_end; i += 32) {
                const ivec2 at = seen_at(i, cocs[i]);
                if (at.x < -1 || front[cell_of(at)] == 0UL) continue;
                atomicMax(front[cell_of(at)], key_of(uppers[i], solids[i - push.sample_count]));
            }
        }
    }
    barrier();
}

// A facet's corners as the lens point sees them, in cells of the tile.
struct Triangle {
    vec3 x, y;
    uint corner[3]; // samples
};

Triangle triangle_of(uint facet) {
    Triangle t;
    for (uint k = 0; k < 3; ++k) {
        t.corner[k] = facets[3 * facet + k];
        const vec2 place = places[t.corner[k]];
        const float coc = cocs[t.corner[k]];
        t.x[k] = seen_along(place.x, first.x - 1, coc, lens.x, lens.pixel_x + shift_of_facets);
        t.y[k] = seen_along(place.y, first.y - 1, coc, lens.y, lens.pixel_y + shift_of_facets);
    }
    return t;
}

float least_of(vec3 at) { return min(min(at[0], at[1]), at[2]); }
float most_of(vec3 at) { return max(max(at[0], at[1]), at[2]); }

// Returns the cells of the quarter whose middle lies between the corners, along one axis.
ivec2 extent_of(vec3 at, int corner_) {
    const float last = tile_stride - border;
    return ivec2(max(first_between(least_of(at), last), corner_ + 1), min(last_between(most_of(at), last), corner_ + side));
}

bool parted(vec3 at) { return most_of(at) - least_of(at) > parted_px; }

// Twice the area of the triangle between two corners and a point.
float area(Triangle t, uint from, uint to, vec2 at) {
    return twice_area(t.x[from], t.y[from], t.x[to], t.y[to], at.x, at.y);
}

void draw(Triangle t) {
    const ivec2 columns = extent_of(t.x, corner.x), rows = extent_of(t.y, corner.y);
    const float turned = area(t, 0, 1, vec2(t.x[2], t.y[2])) < 0 ? -1 : 1;
    for (int row = rows[0]; row <= rows[1]; ++row)
        for (int column = columns[0]; column <= columns[1]; ++column) {
            const float a = turned * area(t, 1, 2, vec2(column, row)), b = turned * area(t, 2, 0, vec2(column, row)),
                        c = turned * area(t, 0, 1, vec2(column, row));
            if (a < 0 || b < 0 || c < 0) continue;
            const uint nearest = t.corner[nearest_corner(a, b, c)];
            atomicMax(front[cell_of(ivec2(column, row) - border - corner)], key_of(uppers[nearest], nearest));
        }
}

// Draws facets, which close steep surfaces between their samples, into front[]. Ends with a barrier.
void see_facets(uint list, uint count) {
    for (uint begin = 0; begin < count; begin += threads) {
        find_near(list + begin, count - begin);
        for (uint n = thread() / 32; n < near_count; n += threads / 32) {
            const Block b = blocks[near_blocks[n]];
            for (uint i = b.begin + thread() % 32; i < b.opaque_end; i += 32) {
                const Triangle t = triangle_of(i);
                if (parted(t.x) || parted(t.y)) draw(t);
            }
        }
    }
    barrier();
}

// Finds the images that a lens point sees in mirrors and glass, where their surface is seen. Comes after see_opaque()
// and see_facets().

bool is_image(uint sample_) { return shown[sample_] != cocs[sample_]; }

// The key is greater for a smaller CoC, then for a smaller index.
uint64_t image_key(uint sample_) {
    const float coc = shown[sample_];
    const uint bits = floatBitsToUint(coc == 0 ? 0 : coc);
    return ~key_of((bits >> 31) != 0 ? ~bits : bits | 0x80000000u, sample_);
}

// Finds the nearest image in each cell, into front[cells + cell]. Ends with a barrier.
void see_images(uint list, uint count) {
    for (uint c = thread(); c < cells; c += threads) front[cells + c] = 0UL;
    for (uint begin = 0; begin < count; begin += threads) {
        find_near(list + begin, count - begin);
        for (uint n = thread() / 32; n < near_count; n += threads / 32) {
            const Block b = blocks[near_blocks[n]];
            for (uint i = b.begin + thread() % 32; i < b.opaque_end; i += 32) {
                if (!is_image(i)) continue;
                const ivec2 at = seen_at(i, shown[i]);
                if (at.x >= -1) atomicMax(front[cells + cell_of(at)], image_key(i));
            }
        }
    }
    barrier();
}

// Returns the sample whose image shows in a cell; else the front sample.
uint image_at(uint cell) {
    const uint sample_ = sample_of(front[cell]);
    if (!is_image(sample_)) return sample_;
    const uint around[5] = {cell, cell - 1, cell + 1, cell - side, cell + side};
    for (uint n = 0; n < 5; ++n) {
        const uint64_t key = front[cells + around[n]];
        const uint image = sample_of(~key);
        if (key != 0UL && is_in_mirror(depth_of(uppers[image]), depth_of(uppers[sample_]))) return image;
    }
    return sample_;
}

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
