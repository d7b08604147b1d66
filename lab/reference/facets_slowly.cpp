#include "lab/reference/facets_slowly.h"

#include "dof/facets/facets.h"
#include "kernels/lens_rules.h"
#include "lab/reference/find_facets_slowly.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

using V2 = Imath::Vec2<long double>;

long double cross(const V2 &a, const V2 &b) { return a.x * b.y - a.y * b.x; }

// A facet as a lens point sees it, and the point that the lens point looks at.
struct SeenFacet {
    std::array<V2, 3> corner;
    V2 at;
    long double unclear = 0; // how far rounding may move any of these points

    V2 side(std::size_t k) const {
        return corner[(k + 2) % 3] - corner[(k + 1) % 3];
    } // the side opposite corner k
    bool from_behind() const { return cross(side(2), side(0)) < 0; }
    long double weight(std::size_t k) const {
        return (from_behind() ? -1 : 1) * cross(side(k), at - corner[(k + 1) % 3]);
    }

    // Whether all corners are on one side of the point, whatever rounding does. This is true of most facets, and the
    // exact test takes ten times as long.
    bool beside() const {
        const auto &[a, b, c] = corner;
        return std::min({a.x, b.x, c.x}) > at.x + unclear || std::max({a.x, b.x, c.x}) < at.x - unclear ||
               std::min({a.y, b.y, c.y}) > at.y + unclear || std::max({a.y, b.y, c.y}) < at.y - unclear;
    }
    // The distance of the point to the nearest side; less than 0 outside.
    Margin inside() const {
        Margin margin{INFINITY, unclear};
        for (std::size_t k = 0; k < 3; ++k)
            margin.inside = std::min(margin.inside, weight(k) / std::max(side(k).length(), unclear));
        return margin;
    }
    Margin parted() const {
        long double widest = 0;
        for (std::size_t k = 0; k < 3; ++k)
            widest = std::max({widest, std::abs(side(k).x), std::abs(side(k).y)});
        return {widest - (long double)kernels::parted_px, 2 * unclear};
    }
    // How far the point is inside the region where corner k has the largest weight; less than 0 outside.
    Margin nearest(std::size_t k) const {
        Margin margin{INFINITY, unclear};
        for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3})
            margin.inside = std::min(margin.inside, (weight(k) - weight(other)) /
                                                        std::max((side(k) - side(other)).length(), unclear));
        return margin;
    }
};

SeenFacet seen_facet(std::span<const Placed> samples, const std::array<std::size_t, 3> &facet,
                     const LensSample &point, const V2 &at, long double extent) {
    SeenFacet seen{{}, at};
    for (std::size_t k = 0; k < 3; ++k) {
        const Placed &s = samples[facet[k]];
        const V2 displaced(s.coc * (long double)point.x, s.coc * (long double)point.y);
        seen.corner[k] = V2(s.x, s.y) + displaced;
        seen.unclear = std::max(seen.unclear, 5e-7L * extent + 1e-6L * displaced.length());
    }
    return seen;
}

} // namespace

std::vector<std::array<std::size_t, 3>> place_facets_slowly(const Ldi &ldi, const ThinLens &lens,
                                                            std::span<const Placed> samples) {
    std::vector<std::size_t> place(ldi.samples());
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (!samples[i].background) place[samples[i].source] = i;
    std::vector<std::array<std::size_t, 3>> facets;
    for (const auto &sample : find_facets_slowly(ldi, lens, 1))
        facets.push_back({place[sample[0]], place[sample[1]], place[sample[2]]});
    return facets;
}

void cover_by_facets(std::span<const Placed> samples, std::span<const std::array<std::size_t, 3>> facets,
                     const LensSample &point, const V2 &at, long double extent, std::vector<Cover> &covers) {
    covers.assign(facets.empty() ? 0 : samples.size(), {});
    for (const auto &facet : facets) {
        const SeenFacet seen = seen_facet(samples, facet, point, at, extent);
        if (seen.beside()) continue;
        const Margin inside = seen.inside(), parted = seen.parted();
        if (inside.outside() || parted.outside()) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const Margin nearest = seen.nearest(k);
            if (nearest.outside()) continue;
            const bool is = inside.inside > 0 && parted.inside > 0 && nearest.inside > 0;
            covers[facet[k]].add({true, is, inside.sure() && parted.sure() && nearest.sure()});
        }
    }
}

} // namespace sparselens
