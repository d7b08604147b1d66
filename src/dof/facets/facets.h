// Facets: triangles that close surfaces so steep that their samples part as seen from some points of the lens.
//
// Two opaque samples of adjacent pixels whose disparities differ by D move apart by D pixels towards the rim of
// the lens. What lies behind then shows between them, unless the surface is known to continue from one to the other. It
// does (the samples are linked) if |D| is less than steep_px, or if D is one of three steps of depth that follow each
// other in a row or a column and have the same sign. D may be the first, the second or the third of them, but a surface
// that goes on level beyond D has no further step: what lies deeper there is a layer behind it. S is the smaller of the
// other two steps, for the choice with the largest S. Then
//   |D| < steep_px + 2 S
// links a slope to where it ends, and a curved slope to itself. A silhouette has no such steps: both surfaces are flat,
// and only one step is steep, or two if a pixel has a depth between them. A sample has at most one link in each
// direction: to the sample nearest in depth.
//
// A facet is a triangle between three samples of the four pixels that meet in a corner. One of its samples lies in the
// upper left pixel, two of its sides are links, and some side is steep. Four samples that are linked all around form
// two facets, divided by the diagonal from the upper left. Seen through the lens, a facet extends the footprints of its
// samples: each of its points belongs to the sample that weighs most there (barycentric coordinates), unless the
// squares of its samples cover the facet (kernels/lens_rules.h).
#pragma once

#include "base/light.h"
#include "deep/build.h"
#include "deep/ldi.h"
#include "lens/thin_lens.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sparselens {

struct Facet {
    std::array<std::uint32_t, 3> sample; // indices into the LDI
};

// Facets in blocks of `size` by `size` pixels. A facet is in the block of the upper left of its four pixels.
struct FacetBlocks {
    static constexpr int size = 8;
    std::vector<std::vector<Facet>> blocks; // only those with facets, row by row
};

// `widest`: the largest distance of a lens point from the middle, in pixels per pixel of CoC. The LDI must have fewer
// than 2^32 samples.
FacetBlocks find_facets(const Ldi &ldi, const ThinLens &lens, double widest);

// Finds which opaque samples of adjacent pixels, and of cells of several pixels, lie on one surface. The beginning of
// this file says when they are linked.

struct LinkedSample {
    static constexpr std::uint32_t none = ~0u;
    std::uint32_t sample = none; // index into the LDI
    float depth = 0;             // disparity, pixels
    bool found() const { return sample != none; }
};

class Links {
public:
    Links(const Ldi &ldi, const ThinLens &lens)
        : ldi_(ldi), alpha_(ldi.alpha()), depth_at_1_(float(disparity(lens, 1))) {}

    // Calls visit(sample) for the opaque samples of a pixel. A pixel outside the window has none.
    template <typename Visit>
    void for_each_opaque(const Position &pixel, const Visit &visit) const {
        if (!ldi_.windows.grid().contains(pixel)) return;
        for (const std::uint64_t i : ldi_.pixel(ldi_.windows.index(pixel)))
            if (is_opaque(alpha_at(ldi_, alpha_, i)))
                visit(LinkedSample{std::uint32_t(i), depth_at_1_ / ldi_.z[i]});
    }

    // Returns this sample of the LDI; none if it is not opaque.
    LinkedSample opaque(std::uint32_t sample) const {
        if (!is_opaque(alpha_at(ldi_, alpha_, sample))) return {};
        return {sample, depth_at_1_ / ldi_.z[sample]};
    }

    // Returns the sample in the pixel one step on that `a`, a sample of `pixel`, is linked to; none if there is no
    // link.
    LinkedSample linked(const LinkedSample &a, const Position &pixel, const Imath::V2i &step) const;

private:
    LinkedSample nearest(const Position &pixel, float depth) const;
    using Steps = std::array<float, 2>;
    Steps steps_beyond(const LinkedSample &from, const Position &pixel, const Imath::V2i &step,
                       float expected) const;

    const Ldi &ldi_;
    std::size_t alpha_;
    float depth_at_1_;
};

// Finds which samples of a cell of several pixels lie on one surface, however steep it is. Returns, for each sample of
// the LDI, the first sample of its cell that links lead to from it, from pixel to pixel within the cell. Cells are
// `across` pixels wide and high; the first one begins at EXR coordinate (0, 0). The result is the sample itself if it
// shows an image (Ldi::image_z), and in cells whose opaque samples lie at most `apart` pixels of disparity from
// each other, where the answer is not needed. The LDI must have fewer than 2^32 samples.
std::vector<std::uint32_t> joined_in_cells(const Ldi &ldi, const Links &links, int across, float apart);

} // namespace sparselens
