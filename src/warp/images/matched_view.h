// A view as the search for images compares it: bounded colours, smoothed a little, and the depth of its surfaces.
#pragma once

#include "deep/ldi.h"
#include "view/view_mapping.h"

#include <array>
#include <limits>
#include <vector>

namespace sparselens {

// Pixels of perceptive depth: pixels a few pixels apart that differ by no more show one surface.
inline constexpr float one_mirror_px = 1;

// A view of one sample a pixel or, on silhouettes, more; the mapping tells where it stands.
struct PlacedView {
    const Ldi *samples;
    const ViewMapping *mapping;
};

class MatchedView {
public:
    // R, G and B, tone-mapped so that one bright pixel does not decide, and the perceptive depth of the surface, which
    // is NaN where the pixel or one beside it shows several surfaces, none or another one: the colours are mixed there.
    using Pixel = std::array<float, 4>;

    // `scale` is R F. The view must outlive this.
    MatchedView(const PlacedView &view, double scale);

    bool contains(int x, int y) const { return grid_.contains(x, y); }
    const Pixel &at(int x, int y) const { return pixels_[grid_.index(x, y)]; }
    // Between the middles of pixels, which lie at halves; the depth is that of the pixel which holds the place. False
    // outside of them.
    bool at(const Imath::V2d &place, Pixel &out) const;

    // Of the surface, if the pixel shows just one; else NaN.
    float depth(int x, int y) const {
        return contains(x, y) ? depths_[grid_.index(x, y)] : std::numeric_limits<float>::quiet_NaN();
    }

    const ViewMapping &mapping() const { return *view_.mapping; }
    const Ldi &samples() const { return *view_.samples; }

private:
    void smooth();
    void mark_mixed();

    PlacedView view_;
    Grid grid_;
    std::vector<Pixel> pixels_;
    std::vector<float> depths_;
};

} // namespace sparselens
