// Finds what leaves the frame at the pixels of its border: which samples, and how far the small lights among them
// continue; and how far the light of border pixels reaches.
#pragma once

#include "deep/ldi.h"
#include "lens/thin_lens.h"

#include <Imath/ImathBox.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace sparselens {

// The samples of a pixel; none outside of the data window.
inline SampleRange samples_at(const Ldi &ldi, const Imath::V2i &at) {
    return ldi.windows.data.intersects(at) ? ldi.pixel(ldi.windows.index(at.x, at.y)) : SampleRange{};
}

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

// A side of the frame.
struct FrameSide {
    Imath::V2i first, step, out; // its first pixel; from there to the next; away from the frame
    int count;                   // of pixels
    bool looked;                 // whether rim views looked past it

    // The pixel that is n pixels beyond the i-th.
    Imath::V2i pixel(int i, int n) const { return first + i * step + n * out; }
};

class Border {
public:
    // `across`: pixels, across and down, that become one pixel of the picture, in which distances are counted.
    // `views_radius`: the radius of the lens from whose rim views looked, scene units; 0: the radius of `lens`.
    Border(const Ldi &ldi, const ThinLens &lens, int across, double views_radius);

    std::vector<BorderPixel> pixels(const FrameSide &side) const;
    // Whether these samples of a pixel let no light through.
    bool closed(const SampleRange &range) const;
    SampleRange samples(const Imath::V2i &at) const { return samples_at(ldi_, at); }
    double depth(std::uint64_t sample) const { return disparity(lens_, double(ldi_.z[sample])); }

private:
    std::vector<BorderSample> leaving(const FrameSide &side, int i, float level) const;
    bool seen_last(std::uint64_t sample, const FrameSide &side, int i, int n) const;
    void find_end(BorderPixel &of, const FrameSide &side, int i) const;
    double front(const Imath::V2i &at) const;
    bool shows(const SampleRange &range, double there) const;
    float extent(const FrameSide &side, int at, int n, std::uint64_t sample, float level) const;
    float light_at(const Imath::V2i &at, double there) const;
    float brightness(std::uint64_t sample) const;
    // How far rim views showed its surface beyond the frame, pixels.
    double shown_until(std::uint64_t sample) const { return wider_ * depth(sample); }

    const Ldi &ldi_;
    const ThinLens &lens_;
    int across_;
    double wider_; // the radius of the lens from whose rim views looked, divided by this lens's
    std::size_t alpha_;
    std::vector<std::size_t> brightness_;
};

// How far light reaches beyond the sides of a window, pixels: to the left and up, to the right and down.
struct WindowReach {
    Imath::V2d before{0, 0}, after{0, 0};

    // Adds the light of a pixel of the border, which reaches `by` pixels from where the picture shows it.
    void add(const Imath::Box2i &window, const Imath::V2i &at, const Imath::V2d &by, const Imath::V2d &shown);
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
