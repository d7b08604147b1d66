// The sums of what pixels have seen so far. What is known is summed up for each channel if lens points weigh
// differently for colours or for what lies behind focus and in front, or if not all pixels see through them.

struct Sum {
    vec4 light;
    vec4 weight; // the known weight of each channel; without the rule `weighted`, x: the unknown weight
};

// Adds what the lens point sees: a sample, or something unknown (`none`), behind partial samples. `passes`: the share
// of the sample's light that a holdout lets through.
void add_seen(inout Sum sum, uint seen, float passes, Over over, uint group) {
    const vec4 behind = seen != none ? colours[group * push.sample_count + seen] : vec4(0);
    precise vec4 light = sum.light;
    precise float unknown = sum.weight.x;
    if (seen != none) light = light + lens.weight * passes * behind;
    else unknown = unknown + lens.weight;
    if (over.transmittance < 1) {
        precise const float hidden = 1 - over.transmittance;
        precise vec4 in_front = over.colour;
        if (seen != none) in_front = in_front - hidden * passes * behind;
        else unknown = unknown - lens.weight * hidden;
        light = light + lens.weight * in_front;
    }
    sum = Sum(light, vec4(unknown));
}

// Returns the weight of the lens point for each channel, for what lies in front of focus or behind.
vec4 channel_weights(uint group, bool in_front) {
    const vec3 sides = in_front ? vec3(lens.red_in_front, lens.green_in_front, lens.blue_in_front)
                                : vec3(lens.red_behind, lens.green_behind, lens.blue_behind);
    vec4 weights;
    for (uint k = 0; k < 4; ++k) {
        const uint set = sets[group * 4 + k];
        const float side_ = of_colour(set, sides.x, sides.y, sides.z, sides.y);
        weights[k] = light_weight(set, lens.weight, of_colour(set, lens.red, lens.green, lens.blue, 1), side_);
    }
    return weights;
}

// Returns how these weights count in the divisor of the sum.
vec4 known_weights(uint group, vec4 weights) {
    for (uint k = 0; k < 4; ++k)
        if (is_darkened(sets[group * 4 + k], (rules & darkens) != 0)) weights[k] = lens.weight;
    return weights;
}

// Whether a pixel of the tile sees through the tile's lens point number `k`. For each row, columns[] says where the
// pixels that do begin and end, 8 bits each.
bool seen_through(Tile tile, uint k, ivec2 at) {
    if ((rules & cat_eye) == 0) return true;
    const uint row = columns[tile.columns + (k * 2 * size + at.y) / 2] >> 16 * (at.y % 2);
    return at.x >= int(row & 255) && at.x < int(row >> 8 & 255);
}

// Backgrounds lie behind focus, wherever they are seen.
bool in_front_of_focus(uint sample_) {
    if ((rules & two_sided) == 0 || sample_ == none) return false;
    return (sample_ >= push.first_filler || uppers[sample_] > background_upper) && shown[sample_] < 0;
}

void add_weighted(inout Sum sum, vec4 weight, vec4 light, float covered, vec4 colour) {
    precise vec4 lights = sum.light + light * colour;
    precise vec4 known = sum.weight + weight * covered;
    sum = Sum(lights, known);
}

// Like add_seen(), with weights for each channel.
void add_seen_weighted(inout Sum sum, uint seen, float passes, Over over, uint group) {
    const vec4 lights[2] = {channel_weights(group, false), channel_weights(group, true)};
    const vec4 weights[2] = {known_weights(group, lights[0]), known_weights(group, lights[1])};
    const uint side_ = in_front_of_focus(seen) ? 1 : 0;
    precise const vec4 behind = seen != none ? passes * colours[group * push.sample_count + seen] : vec4(0);
    if (seen != none) add_weighted(sum, weights[side_], lights[side_], 1, behind);
    if (over.transmittance >= 1) return;
    precise const float hidden = 1 - over.transmittance;
    precise const float hidden_behind = hidden - over.hidden_in_front;
    add_weighted(sum, weights[0], lights[0], hidden_behind, over.colour);
    if ((rules & two_sided) != 0) add_weighted(sum, weights[1], lights[1], over.hidden_in_front, over.colour_in_front);
    precise const vec4 taken = behind * -hidden;
    if (seen != none) add_weighted(sum, weights[side_], lights[side_], -hidden, taken);
}

// The known weight of each channel.
vec4 known_of(Sum sum, float total) {
    vec4 known = (rules & weighted) != 0 ? sum.weight : vec4(total - sum.weight.x);
    for (uint k = 0; k < 4; ++k) known[k] = known_weight(known[k], total);
    return known;
}
