// What a lens point sees through facets, slowly: facets.h and lens_gather_reference.h say by which rules.
#pragma once

#include "lab/reference/seen_slowly.h"

namespace sparselens {

// Whether a lens point sees a sample at a place.
struct Cover {
    bool possible = false; // by some way of rounding
    bool seen = false, sure = false;

    void add(const Cover &other) {
        possible = possible || other.possible;
        seen = seen || other.seen;
        sure = sure || other.sure;
    }
};

// The facets as indices into `samples`.
std::vector<std::array<std::size_t, 3>> place_facets_slowly(const Ldi &ldi, const ThinLens &lens,
                                                            std::span<const Placed> samples);

// Covers each sample through facets alone; empty if there are none.
void cover_by_facets(std::span<const Placed> samples, std::span<const std::array<std::size_t, 3>> facets,
                     const LensSample &point, const Imath::Vec2<long double> &at, long double extent,
                     std::vector<Cover> &covers);

} // namespace sparselens
