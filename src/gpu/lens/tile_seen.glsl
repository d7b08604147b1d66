// Finds the nearest sample in each cell that the lens points see: of opaque ones, of facets between them (dof/facets)
// and of solids behind them (dof/lens/sample_blocks.h). Each sample is read once for all of the lens points.

// Returns where a sample is, and its CoC, in units of the tile.
ivec3 whole_of(vec2 place, float coc) {
    const vec2 middle = first + size;
    const float x = place_if_seen(place.x, coc, units.widest);
    return ivec3(whole_place(x, middle.x, units.unit, units.farthest),
                 whole_place(place.y, middle.y, units.unit, units.farthest),
                 whole_coc(coc, units.unit * units.lens_unit, units.unit * units.farthest));
}

// Returns the pixel of the quarter, or next to it, in which a lens point sees a sample; outside: x < -1.
ivec2 seen_at(ivec3 sample_, ivec4 eye) {
    const ivec2 seen = sample_.xy + ivec2(moved(sample_.z, eye.x), moved(sample_.z, eye.y)) + eye.zw,
                at = (seen >> findMSB(int(units.unit))) + size - corner;
    const bool inside = all(greaterThanEqual(at, ivec2(-1))) && all(lessThanEqual(at, ivec2(size)));
    return inside ? at : ivec2(-2);
}

bool out_of_reach(Block b, vec4 eye) {
    const vec2 a = b.coc_min * eye.xy, c = b.coc_max * eye.xy, least = min(a, c), most = max(a, c),
               begin = first + vec2(corner) - 1 - eye.zw, end = begin + side;
    return b.x_max + most.x + 1 < begin.x || b.x_min + least.x - 1 > end.x || b.y_max + most.y + 1 < begin.y ||
           b.y_min + least.y - 1 > end.y;
}

// Lists the blocks that any lens point moves into the quarter, out of up to `workers` blocks, and returns the first one
// of the thread. Begins and ends with a barrier.
uint first_near(uint list, uint count) {
    barrier();
    if (thread() == 0) near_count = 0;
    barrier();
    if (thread() < count) {
        const Block b = blocks[block_lists[list + thread()]];
        bool reaches = false;
        [[dont_unroll]] for (uint l = 0; l < points; ++l) reaches = reaches || !out_of_reach(b, eyes[l]);
        if (reaches) near[atomicAdd(near_count, 1)] = uvec3(b.begin, b.opaque_end, number_of_sample(b.begin));
    }
    barrier();
    return thread() / team;
}

// Runs what follows for i.x = each opaque sample, or facet, of listed blocks, for all lens points. i.z: its number.
#define FOR_NEAR(i, list, count)                                                                    \
    for (uint listed_ = 0; listed_ < (count); listed_ += workers)                                   \
        for (uint n_ = first_near((list) + listed_, (count) - listed_); n_ < near_count; n_ += workers / team) \
            for (uvec3 i = near[n_] + uvec3(1, 0, -1) * (thread() % team); i.x < i.y; i.x += team, i.z -= team)

// Finds the images that a lens point sees in mirrors and glass, where their surface is seen.

bool is_image(uint sample_) { return shown[sample_] != cocs[sample_]; }

// Finds the nearest samples of a kind: those that show themselves; solids, which hide what lies behind them, in cells
// that show something; and images.
void see(uint kind, uint list, uint count) {
    ivec4 from[points]; // whole_eyes[], in registers
    for (uint l = 0; l < points; ++l) from[l] = whole_eyes[l];
    FOR_NEAR(i, list, count) {
        if (kind == images && !is_image(i.x)) continue;
        const ivec3 whole = whole_of(places[i.x], kind == images ? shown[i.x] : cocs[i.x]);
        const uint number = kind == with_solids ? number_of_sample(solids[i.x - push.sample_count]) : i.z;
        uint code = code_in(i.x);
        if (kind == images) code = image_code(shown[i.x], units.farthest, units.image_codes);
        uint word = word_of(code, number);
        if (uppers[i.x] < hiding) word -= hiding;
        for (uint l = 0; l < points; ++l) {
            const ivec2 at = seen_at(whole, from[l]);
            if (at.x < -1 || (kind == with_solids && front[cell_of(l, at)] < hiding)) continue;
            atomicMax(front[(kind == images ? images_from : 0) + cell_of(l, at)], word);
        }
    }
}

// A facet's corners as a lens point sees them, in cells of the tile.
struct Triangle {
    vec3 x, y;
    uint corner[3]; // samples
};

Triangle triangle_of(uint facet, vec4 eye) {
    Triangle t;
    for (uint k = 0; k < 3; ++k) {
        t.corner[k] = facets[3 * facet + k];
        const vec2 place = places[t.corner[k]];
        const float coc = cocs[t.corner[k]];
        t.x[k] = seen_along(place.x, first.x - 1, coc, eye.x, eye.z + shift_of_facets);
        t.y[k] = seen_along(place.y, first.y - 1, coc, eye.y, eye.w + shift_of_facets);
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

void draw(Triangle t, uint l) {
    const ivec2 columns = extent_of(t.x, corner.x), rows = extent_of(t.y, corner.y);
    const float turned = area(t, 0, 1, vec2(t.x[2], t.y[2])) < 0 ? -1 : 1;
    for (int row = rows[0]; row <= rows[1]; ++row)
        for (int column = columns[0]; column <= columns[1]; ++column) {
            const float a = turned * area(t, 1, 2, vec2(column, row)), b = turned * area(t, 2, 0, vec2(column, row)),
                        c = turned * area(t, 0, 1, vec2(column, row));
            if (a < 0 || b < 0 || c < 0) continue;
            const uint nearest = t.corner[nearest_corner(a, b, c)];
            atomicMax(front[cell_of(l, ivec2(column, row) - border - corner)],
                      word_of(code_in(nearest), number_of_sample(nearest)));
        }
}

// Draws facets, which close steep surfaces between their samples.
void see_facets(uint list, uint count) {
    FOR_NEAR(i, list, count)
        [[dont_unroll]] for (uint l = 0; l < points; ++l) {
            const Triangle t = triangle_of(i.x, eyes[l]);
            if (parted(t.x) || parted(t.y)) draw(t, l);
        }
}

// Returns the word of the sample whose image shows in a cell; else of the front sample.
uint image_at(uint cell) {
    const uint sample_ = sample_at(cell);
    if (!is_image(sample_)) return front[cell];
    const uint around[5] = {cell, cell - 1, cell + 1, cell - side, cell + side};
    for (uint n = 0; n < 5; ++n) {
        const uint word = front[images_from + around[n]], image = sample_of(word);
        if (word != 0 && is_in_mirror(depth_in(image), depth_in(sample_))) return word;
    }
    return front[cell];
}

// Finds what a lens point sees where it meets no opaque sample, or only one far behind: a surface through the cracks
// between its samples, else fillers.

// The depth code of the opaque sample at a cell; 0: there is none.
uint opaque_at(uint cell) { return front[cell] >= hiding ? code_of(front[cell]) : 0; }

// Returns the word of the sample that shows through a crack at a cell; 0: there is no crack. `axes`: bits,
// as Odd has them.
uint torn_at(uint cell, uint axes) {
    uint farthest = 0;
    float farthest_depth = 0;
    for (; axes != 0; axes &= axes - 1) {
        const uint s = findLSB(axes), step_ = s == 0 ? 1 : s == 1 ? side : side + 2 * s - 5;
        const uint one = front[cell - step_], other = front[cell + step_], a = sample_of(one), b = sample_of(other);
        const vec2 apart = places[a] - places[b];
        const float depth_a = depth_in(a), depth_b = depth_in(b), depth = min(depth_a, depth_b);
        if (!is_crack(apart.x, apart.y, depth_a, depth_b) || (farthest != 0 && depth >= farthest_depth)) continue;
        farthest = depth_a <= depth_b ? one : other;
        farthest_depth = depth;
    }
    return farthest;
}

// Whether something of this depth code is behind what a cell shows, or behind a surface that is torn there.
bool hides(uint cell, uint code) {
    const uint limit = behind_filler(code, units.codes);
    return opaque_at(cell) > limit || (opaque_at(cell - 1) > limit && opaque_at(cell + 1) > limit) ||
           (opaque_at(cell - side) > limit && opaque_at(cell + side) > limit);
}

// One bit for each cell of the thread. odd: the cell may show something else than its front sample. odd_axes: two
// opposite neighbours are both in front of the cell: in its row, in its column, or on one of its diagonals.
uint odd[points];
uvec4 odd_axes[points];

// What repair_odd() found for one of these cells.
struct Repaired {
    uint cell, front, shows; // words
};
Repaired repaired[own * points];

// Returns the j-th cell of the thread, which has the cells of `wide` adjacent columns.
uint cell_of_thread(uint l, uint j) {
    const uint across = size / wide;
    const uint x = thread() % across * wide + j % wide, y = thread() / across * (own / wide) + j / wide;
    return cell_of(l, ivec2(x, y));
}

// Finds empty cells and cracks, and where images may show.
void find_odd() {
    [[dont_unroll]] for (uint l = 0; l < points; ++l) {
        uint cell = cell_of_thread(l, 0) - 1, above[wide + 2], here[wide + 2], below[wide + 2], some = 0;
        uvec4 axes = uvec4(0);
        for (uint k = 0; k < wide + 2; ++k) {
            above[k] = opaque_at(cell + k - side);
            here[k] = opaque_at(cell + k);
        }
        [[dont_unroll]] for (uint j = 0; j < own; j += wide) {
            cell += side;
            for (uint k = 0; k < wide + 2; ++k) below[k] = opaque_at(cell + k);
            for (uint k = 0; k < wide; ++k) {
                const uvec4 nearest = min(uvec4(here[k], above[k + 1], above[k + 2], above[k]),
                                          uvec4(here[k + 2], below[k + 1], below[k], below[k + 2]));
                axes |= uvec4(greaterThan(nearest, uvec4(behind_crack(here[k + 1], units.codes)))) << (j + k);
                some |= uint(has_images || here[k + 1] == 0) << (j + k);
            }
            above = here;
            here = below;
        }
        odd[l] = some | axes.x | axes.y | axes.z | axes.w;
        odd_axes[l] = axes;
    }
}

void repair_odd() {
    uint count = 0;
    for (uint l = 0, left = odd[0]; ; left &= left - 1) {
        while (left == 0 && l + 1 < points) left = odd[++l];
        if (left == 0) break;
        const uint j = findLSB(left), cell = cell_of_thread(l, j);
        const uvec4 axes = odd_axes[l] >> j & 1;
        const uint torn = torn_at(cell, axes.x | axes.y << 1 | axes.z << 2 | axes.w << 3), word = front[cell];
        const bool is_filler = word < hiding, hidden = is_filler && hides(cell, code_of(word));
        const uint shows = torn != 0 ? torn : hidden ? 0 : word;
        repaired[count].cell = cell;
        repaired[count].front = shows;
        if (has_images) repaired[count].shows = torn != 0 || is_filler ? shows : image_at(cell);
        ++count;
    }
    barrier();
    for (uint n = 0; n < count; ++n) {
        front[repaired[n].cell] = repaired[n].front;
        if (has_images) front[images_from + repaired[n].cell] = repaired[n].shows;
    }
}

// Finds what lies behind the partial samples in the quarter's pixels, into front[]. Ends with a barrier.
void see_behind(Tile tile) {
    for (uint c = thread(); c < fronts; c += workers) front[c] = 0;
    see(0, tile.blocks, tile.block_count + tile.filler_count);
    if ((rules & with_facets) != 0) see_facets(tile.facets, tile.facet_count);
    if ((rules & with_solids) != 0) {
        barrier();
        see(with_solids, tile.solids, tile.solid_count);
    }
    if (has_images) see(images, tile.blocks, tile.block_count);
    barrier();
    find_odd();
    repair_odd();
    barrier();
}
