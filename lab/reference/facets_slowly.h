// Finds slowly what a lens point sees through facets, by the rules in facets.h and lens_gather_reference.h.
#pragma once

#include "lab/reference/seen_slowly.h"

namespace sparselens {

// Whether a lens point sees a sample at a point.
struct Cover {
    bool possible = false; // if rounding falls one way
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

// Tests each sample through facets alone; empty if there are no facets.
void cover_by_facets(std::span<const Placed> samples, std::span<const std::array<std::size_t, 3>> facets,
                     const LensSample &point, const Imath::Vec2<long double> &at, long double extent,
                     std::vector<Cover> &covers);

} // namespace sparselens
