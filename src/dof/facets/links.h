// Finds which opaque samples of adjacent pixels, and of cells of several pixels, lie on one surface; facets.h says when
// they are linked.
#pragma once

#include "base/coverage.h"
#include "deep/build.h"
#include "deep/ldi.h"
#include "lens/thin_lens.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sparselens {

struct LinkedSample {
    static constexpr std::uint32_t none = ~0u;
    std::uint32_t sample = none; // index into the LDI
    float depth = 0;             // perceptive depth, pixels
    bool found() const { return sample != none; }
};

class Links {
public:
    Links(const Ldi &ldi, const ThinLens &lens)
        : ldi_(ldi), alpha_(ldi.alpha()), depth_at_1_(float(perceptive_depth(lens, 1))) {}

    // Calls visit(sample) for the opaque samples of a pixel, which is relative to the data window's corner. A pixel
    // outside the window has none.
    template <typename Visit>
    void for_each_opaque(const Imath::V2i &pixel, const Visit &visit) const {
        const Imath::V2i at = pixel + ldi_.windows.data.min;
        if (!ldi_.windows.data.intersects(at)) return;
        for (const std::uint64_t i : ldi_.pixel(ldi_.windows.index(at.x, at.y)))
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
    LinkedSample linked(const LinkedSample &a, const Imath::V2i &pixel, const Imath::V2i &step) const;

private:
    LinkedSample nearest(const Imath::V2i &pixel, float depth) const;
    using Steps = std::array<float, 2>;
    Steps steps_beyond(const LinkedSample &from, const Imath::V2i &pixel, const Imath::V2i &step,
                       float expected) const;

    const Ldi &ldi_;
    std::size_t alpha_;
    float depth_at_1_;
};

// Finds which samples of a cell of several pixels lie on one surface, however steep it is. Returns, for each sample of
// the LDI, the first sample of its cell that links lead to from it, from pixel to pixel within the cell. Cells are
// `across` pixels wide and high; the first one begins at EXR coordinate (0, 0). The result is the sample itself if it
// shows an image (Ldi::optical), and in cells whose opaque samples lie at most `apart` pixels of perceptive depth from
// each other, where the answer is not needed. The LDI must have fewer than 2^32 samples.
std::vector<std::uint32_t> joined_in_cells(const Ldi &ldi, const Links &links, int across, float apart);

} // namespace sparselens
