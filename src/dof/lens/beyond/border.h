// What leaves the frame at the pixels of its border: which samples, how far the small lights among them, and how far their
// light reaches.
#pragma once

#include "deep/ldi.h"
#include "lens/lens_looks.h"
#include "lens/reach/light_reach.h"
#include "lens/thin_lens.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace sparselens {

// A sample of a pixel at the border.
struct Leaving {
    std::uint32_t sample;
    double depth; // perceptive, pixels
    // Beyond the border, pixels, of the small light that it is part of.
    float extent = std::numeric_limits<float>::infinity();

    // How much of its light goes on n pixels beyond the border.
    float light(int n) const {
        const float share = extent / float(n);
        return share >= 1 ? 1 : share * share;
    }
};

struct BorderPixel {
    std::vector<Leaving> leaving; // front to back
    bool open = true;             // lets light through to infinity
};

class Border {
public:
    Border(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks);

    // How far its light reaches.
    Imath::V2d reach(const Imath::V2i &at) const;
    // How far right and down lies what the magnified picture shows there.
    Imath::V2d shown_beside(const Imath::V2i &at) const;
    // All of a side: from a pixel on, along `step`; the frame lies at `in`.
    std::vector<BorderPixel> side(const Imath::V2i &first, const Imath::V2i &step, const Imath::V2i &in,
                                  int count) const;
    // Whether samples of that pixel leave no light.
    bool closed(const SampleRange &range) const;
    SampleRange samples(const Imath::V2i &at) const {
        return ldi_.windows.data.intersects(at) ? ldi_.pixel(ldi_.windows.index(at.x, at.y)) : SampleRange{};
    }

private:
    Leaving outermost(std::uint32_t sample, Imath::V2i at, const Imath::V2i &out) const;
    std::optional<std::uint32_t> same_surface(const SampleRange &range, double there) const;
    std::vector<float> brightest(const Imath::V2i &first, const Imath::V2i &step, int count) const;
    double depth(std::uint64_t i) const { return perceptive_depth(lens_, double(ldi_.z[i])); }
    float brightness(std::uint64_t i) const;

    const Ldi &ldi_;
    const ThinLens &lens_;
    LightReach light_;
    std::size_t alpha_;
    std::vector<std::size_t> brightness_;
};

} // namespace sparselens
