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
