// Finds what leaves the frame at the pixels of its border: which samples, how far the small lights among them continue,
// and how far their light reaches.
#pragma once

#include "deep/ldi.h"
#include "lens/lens_looks.h"
#include "lens/psf.h"
#include "lens/thin_lens.h"

#include <Imath/ImathBox.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace sparselens {

// A sample that continues beyond the frame.
struct BorderSample {
    std::uint32_t sample;
    double depth; // disparity, in pixels of the lens from whose rim views looked
    int from;     // where it was seen last: pixels beyond the border
    float extent; // how far beyond that its small light reaches, pixels; infinite for all else

    // How much of its light goes on n pixels beyond the border.
    float light(int n) const {
        const float share = extent / float(n - from);
        return share >= 1 ? 1 : share * share;
    }
};

// At a pixel of the border.
struct BorderPixel {
    std::vector<BorderSample> leaving;
    bool open = true; // lets light through to infinity
    // The surface in front ends `ends` pixels beyond the border. Beyond its end, what lies behind it continues, as it
    // is `behind` pixels within the border.
    int ends = std::numeric_limits<int>::max(), behind = 0;
};

class Border {
public:
    // `across`: pixels, across and down, that become one pixel of the picture, in which distances are counted.
    // `views_radius`: the radius of the lens from whose rim views looked, scene units; 0: the radius of `lens`.
    Border(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks, int across, double views_radius = 0);

    // How far the light of a pixel reaches, in x and y, pixels.
    Imath::V2d reach(const Imath::V2i &at) const;
    // The offset to the right and down from a pixel to what the magnified picture shows there, pixels.
    Imath::V2d shown_beside(const Imath::V2i &at) const;
    // Returns the pixels of a side: `count` pixels from `first` on, along `step`; `out` points away from the frame.
    // `looked`: whether rim views looked past this side.
    std::vector<BorderPixel> side(const Imath::V2i &first, const Imath::V2i &step, const Imath::V2i &out,
                                  int count, bool looked) const;
    // Whether these samples of a pixel let no light through.
    bool closed(const SampleRange &range) const;
    SampleRange samples(const Imath::V2i &at) const {
        return ldi_.windows.data.intersects(at) ? ldi_.pixel(ldi_.windows.index(at.x, at.y)) : SampleRange{};
    }
    double depth(std::uint64_t sample) const { return disparity(lens_, double(ldi_.z[sample])); }

private:
    struct Line;
    std::vector<BorderSample> leaving(const Line &line, int i, float level, bool looked) const;
    bool seen_last(std::uint64_t sample, const Line &line, int i, int n) const;
    void find_end(BorderPixel &of, const Line &line, int i) const;
    double front(const Imath::V2i &at) const;
    bool shows(const SampleRange &range, double there) const;
    float extent(const Line &line, int at, int n, std::uint64_t sample, float level) const;
    float light_at(const Imath::V2i &at, double there) const;
    std::vector<float> brightest(const Imath::V2i &first, const Imath::V2i &step, int count) const;

    float brightness(std::uint64_t sample) const;
    // How far rim views showed its surface beyond the frame, pixels.
    double shown_until(std::uint64_t sample) const { return wider_ * depth(sample); }

    const Ldi &ldi_;
    const ThinLens &lens_;
    int across_;
    double wider_; // the radius of the lens from whose rim views looked, divided by this lens's
    LightReach light_;
    std::size_t alpha_;
    std::vector<std::size_t> brightness_;
};

// Calls visit(x, y) once for each of the outermost pixels of a window.
template <typename Visit>
void for_each_border_pixel(const Imath::Box2i &box, const Visit &visit) {
    for (int x = box.min.x; x <= box.max.x; ++x) {
        visit(x, box.min.y);
        if (box.max.y > box.min.y) visit(x, box.max.y);
    }
    for (int y = box.min.y + 1; y < box.max.y; ++y) {
        visit(box.min.x, y);
        if (box.max.x > box.min.x) visit(box.max.x, y);
    }
}

} // namespace sparselens
