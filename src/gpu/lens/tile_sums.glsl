// The sums of what pixels have seen so far. What is known is summed up for each channel if lens points weigh
// differently for colours or for what lies behind focus and in front, or if not all pixels see through them.

// With the rule `weighted`: of each lens point, behind focus and in front of it, how it counts for light, and in the
// divisor of the sum.
vec4 light_weights[points][2], known_weights[points][2];

float weights[points]; // else

void weigh_channels(uint group) {
    [[dont_unroll]] for (uint l = 0; l < points; ++l)
        for (uint in_front = 0; in_front < 2; ++in_front) {
            const Lens p = lens_points[first_lens + l];
            const vec3 sides = in_front != 0 ? vec3(p.red_in_front, p.green_in_front, p.blue_in_front)
                                             : vec3(p.red_behind, p.green_behind, p.blue_behind);
            for (uint k = 0; k < 4; ++k) {
                const uint set = sets[group * 4 + k];
                const float weight = light_weight(set, p.weight, of_colour(set, p.red, p.green, p.blue, 1),
                                                  of_colour(set, sides.x, sides.y, sides.z, sides.y));
                light_weights[l][in_front][k] = weight;
                known_weights[l][in_front][k] = is_darkened(set, (rules & darkens) != 0) ? p.weight : weight;
            }
        }
}

// Whether a pixel of the quarter sees through a lens point. For each row of the tile, columns[] says where the pixels
// that do begin and end, 8 bits each.
bool seen_through(uint l, ivec2 pixel) {
    if (!has_cat_eye) return true;
    const ivec2 at = pixel + corner;
    const uint row = columns[first_column + (l * 2 * size + at.y) / 2] >> 16 * (at.y % 2);
    return at.x >= int(row & 255) && at.x < int(row >> 8 & 255);
}

// How much light a holdout that stays sharp lets through (deep/merge.h).

float part_of(uint part, uint k) { return uintBitsToFloat(holdouts[held_out + 4 * pixels + 1 + 3 * part + k]); }

// The share of light from a disparity that passes at the thread's pixel `j`.
float passes(uint j, float depth) {
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

// What a lens point sees behind the partial samples in a pixel of the thread.
struct Behind {
    bool is_known;
    uint in_front; // of focus: 1, else 0
    vec4 light;    // that passes the holdout
};

Behind behind_at(uint l, uint j, uint group) {
    const uint cell = cell_of(l, pixel_of(j));
    if (front[cell] == 0) return Behind(false, 0, vec4(0));
    const uint seen = sample_at(has_images ? images_from + cell : cell);
    uint in_front = 0;
    // backgrounds lie behind focus, wherever they are seen
    if (is_two_sided && uppers[seen] != (hiding | background_upper) && shown[seen] < 0) in_front = 1;
    float passed = 1;
    if (has_holdout) passed = passes(j, depth_in(sample_at(cell)));
    return Behind(true, in_front, passed * colours[group * push.sample_count + seen]);
}

// Adds a share of what a lens point sees: light, of which the share `known` is known.
void add(inout Sum sum, uint l, uint in_front, float known, vec4 light) {
    if (is_weighted) {
        sum.light += light_weights[l][in_front] * light;
        sum.weight += known_weights[l][in_front] * known;
    } else {
        sum.light += weights[l] * light;
    }
}
void add_behind(inout Sum sum, uint l, float share, Behind behind) {
    if (behind.is_known) add(sum, l, behind.in_front, share, share * behind.light);
    else if (!is_weighted) sum.weight.x += weights[l] * share;
}

void add_behind(uint group) {
    [[dont_unroll]] for (uint j = 0; j < own; ++j) {
        Sum of = sum[j];
        for (uint l = 0; l < points; ++l)
            if (seen_through(l, pixel_of(j))) add_behind(of, l, 1, behind_at(l, j, group));
        sum[j] = of;
    }
}

// The known weight of each channel.
vec4 known_of(Sum sum, float total) {
    vec4 known = is_weighted ? sum.weight : vec4(total - sum.weight.x);
    for (uint k = 0; k < 4; ++k) known[k] = known_weight(known[k], total);
    return known;
}
