// Composites partial samples in front of the pixels, in order of depth: each takes from the light behind it what it
// hides, and adds its own.

// [lens point][pixel of the thread]: the share of light that the partial samples so far leave behind them
float left[points * own];

const uint no_entry = chunk * points;

// Whether a partial sample of this word is behind a word. Samples of one code are compared by their depth.
bool is_behind(uint word, uint sample_, uint shown_) {
    return word < shown_ || (word - shown_ <= number_mask() && depth_in(sample_) < depth_in(sample_of(shown_)));
}

// Chains up what the lens points show of a chunk, in front of what lies behind, for the owner of each pixel. An entry
// is the lens point times `chunk`, plus the number in the chunk; nexts[] also has the pixel of the quarter. Begins and
// ends with a barrier.
void chain_chunk(uint begin) {
    barrier();
    chains[thread()] = no_entry;
    barrier();
    for (uint n = thread(); n < min(partial_count - begin, chunk); n += workers) {
        const uint i = partial_lists[partial_first + begin + n], word = word_of(code_in(i), number_mask());
        const ivec3 whole = whole_of(places[i], cocs[i]);
        [[dont_unroll]] for (uint l = 0; l < points; ++l) {
            const ivec2 at = seen_at(whole, whole_eyes[l]);
            const bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(size)));
            if (inside && !is_behind(word, i, front[cell_of(l, at)]))
                nexts[l * chunk + n] = atomicExchange(chains[owner_of(uvec2(at))], l * chunk + n) |
                                       (at.y * size + at.x) << 16;
        }
    }
    barrier();
}

uint next_of(uint entry) { return nexts[entry] & 0xffff; }
void chain(uint entry, uint next) { nexts[entry] = nexts[entry] & 0xffff0000 | next; }

// Returns the first entry of the thread's chain, in ascending order. Most entries come in descending order.
uint sorted_chain() {
    uint begin = no_entry;
    for (uint entry = chains[thread()], next; entry != no_entry; entry = next) {
        next = next_of(entry);
        uint before = no_entry, after = begin;
        for (; after < entry; after = next_of(after)) before = after;
        chain(entry, after);
        if (before == no_entry) begin = entry;
        else chain(before, entry);
    }
    return begin;
}

void add_over(uint entry, uint begin, uint group) {
    const uint l = entry / chunk, i = partial_lists[partial_first + begin + entry % chunk], pixel = nexts[entry] >> 16,
               j = pixel / size / rows;
    if (!seen_through(l, pixel_of(j))) return;
    const float before = left[l * own + j], after = left_behind(before, 1 - alphas[i]);
    left[l * own + j] = after;
    float share = before;
    if (has_holdout) share *= passes(j, depth_in(i));
    Sum of = sum[j];
    add(of, l, is_two_sided && cocs[i] < 0 ? 1 : 0, before - after, share * colours[group * push.sample_count + i]);
    add_behind(of, l, after - before, behind_at(l, j, group));
    sum[j] = of;
}

void add_partial(uint group) {
    [[dont_unroll]] for (uint n = 0; n < points * own; ++n) left[n] = 1;
    for (uint begin = 0; begin < partial_count; begin += chunk) {
        chain_chunk(begin);
        for (uint entry = sorted_chain(); entry != no_entry; entry = next_of(entry)) add_over(entry, begin, group);
    }
}
