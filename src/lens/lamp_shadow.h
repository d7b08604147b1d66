// Shadows in the disc of a small lamp, cast by samples in front of the lamp.
//
// A lamp at x, of CoC c, lights the position q of the picture through lens point u = (q - x) / c. Through that lens
// point, a sample at x', of CoC c', is seen at x' + c' u, and hides the lamp at q if q lies there. So its shadow in the
// disc is the sample itself, magnified m = c / (c - c') times about the lamp: q = x + m (x' - x). Both axes have the
// same m, whatever the pixel aspect. Positions are EXR pixel coordinates, y down.
#pragma once

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace sparselens {

// c and c' in pixels, signed and different. `scale`: c in the picture; when drawn elsewhere, the value of c there.
template <typename Number>
Number shadow_magnification(Number lamp_coc, Number coc, Number scale) {
    return scale / (lamp_coc - coc);
}
template <typename Number>
Number shadow_magnification(Number lamp_coc, Number coc) {
    return shadow_magnification(lamp_coc, coc, lamp_coc);
}

struct LampDisc {
    Imath::V2d centre, radius;
    bool contains(double x, double y) const {
        const double u = (x - centre.x) / radius.x, v = (y - centre.y) / radius.y;
        return u * u + v * v <= 1;
    }
    // All pixels of a box.
    bool contains_pixels(const Imath::Box2i &box) const {
        return contains(box.min.x, box.min.y) && contains(box.max.x + 1, box.min.y) &&
               contains(box.min.x, box.max.y + 1) && contains(box.max.x + 1, box.max.y + 1);
    }
    bool contains_pixel(int x, int y) const { return contains_pixels({{x, y}, {x, y}}); }
};

// The share of each pixel of a box that is in shadow, by 64 points in each pixel. No two points share a row or a
// column, so that an edge that crosses a pixel along an axis hides one point after the other.
class LampShadow {
public:
    // Begins with nothing hidden. The box is relative to the origin of places. `fine`: its pixels are so small that a
    // thing that hides a share of the light may hide that share evenly over a pixel.
    void begin(const Imath::Box2i &box, bool fine = false);

    // Adds the shadow of a thing that covers a rectangle and hides a share `alpha` of the light, (0, 1].
    void hide(const Imath::Box2f &rectangle, float alpha, std::uint32_t thing);

    // Whether all of the box is hidden.
    bool dark() const { return lit_pixels_ == 0; }

    // Whether some points of a pixel are hidden, and others are not.
    bool is_crossed(int x, int y) const {
        const std::uint64_t hidden = hidden_[at(x, y)];
        return hidden != 0 && ~hidden != 0;
    }

    // The share of a pixel of the box that is not hidden: of the whole pixel, or of its part that lies in a disc.
    // Shadows of `other`, which has the same box, count too.
    float lit(int x, int y, const LampDisc *disc = nullptr, const LampShadow *other = nullptr) const;

private:
    std::size_t at(int x, int y) const {
        return std::size_t(y - box_.min.y) * width_ + std::size_t(x - box_.min.x);
    }

    Imath::Box2i box_;
    std::size_t width_ = 0;
    float thin_ = 0; // a thing that hides less is a veil over all that it covers of a pixel
    std::vector<std::uint64_t> hidden_; // [pixel]: a bit for each point
    std::size_t lit_pixels_ = 0;        // pixels of which some point is not hidden
    std::vector<float> veil_;           // [pixel]: the share that thin things let through
};

} // namespace sparselens
