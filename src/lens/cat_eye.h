// The part of the aperture that a second circle leaves for pixels away from the optical axis (LensLooks::cat_eye).
#pragma once

#include "lens/aperture.h"
#include "lens/focus_field.h"
#include "lens/lens_looks.h"
#include "lens/lens_samples.h"

#include <Imath/ImathBox.h>

#include <array>
#include <mutex>
#include <vector>

namespace sparselens {

class CatEye {
public:
    CatEye(const Aperture &aperture, const LensLooks &looks, const PictureFrame &frame);

    bool cuts() const { return amount_ > 0; }
    bool darkens() const { return cuts() && darkens_; }

    // The middle of the second circle for a pixel at p, in the units of ApertureShape.
    Imath::V2d centre(const Imath::V2d &p) const { return frame_.place(p) * amount_; }
    // Whether the pixel at p sees through lens point u.
    bool passes(const Imath::V2d &u, const Imath::V2d &p) const { return within(u, centre(p)); }

    struct Columns {
        int begin = 0, end = 0;
    };
    // The pixels of [first, first + count) in row y (EXR coordinates) whose middles see through a lens point, relative
    // to `first`.
    Columns columns(const LensSample &point, int first, int count, int y) const;

    // The share of a colour's light that is left at a pixel, [0, 1]: of light from behind focus or in front, or without
    // these weights.
    enum class Light { behind, in_front, evenly };
    double share(Light light, const Imath::V2d &p, std::size_t colour = 1) const;
    // The same for the pixels of a box, [row][column], to 2e-3, from a table that is made on first use.
    std::vector<double> shares(Light light, const Imath::Box2i &box, std::size_t colour = 1) const;

    // How far the circle's middle moves for each pixel by which a lamp's light is displaced.
    double shift_per_pixel() const { return amount_ / frame_.half_diagonal; }

private:
    bool within(const Imath::V2d &u, const Imath::V2d &middle) const {
        const Imath::V2d off = Imath::V2d(u.x * aperture_.shape().squeeze, u.y) - middle;
        return off.dot(off) <= 1;
    }
    const Aperture &aperture_;
    double amount_;
    bool darkens_;
    PictureFrame frame_;
    double share_of(Light light, std::size_t colour, const Imath::V2d &centre) const;
    double share_from(const std::vector<double> &table, const Imath::V2d &centre) const;

    std::vector<LensPoint> points_;   // for a picture: points are counted
    std::vector<Imath::V2d> outline_; // for other apertures: areas are computed
    double reach_ = 0;                // if its middle is this far away, the circle leaves nothing
    mutable std::array<std::once_flag, 9> made_;
    mutable std::array<std::vector<double>, 9>
        tables_; // [colour][light][angle][radius] of the circle's middle
};

} // namespace sparselens
