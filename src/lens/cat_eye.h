// What a second circle leaves of the aperture away from the optical axis (LensLooks::cat_eye).
#pragma once

#include "lens/aperture.h"
#include "lens/lens_looks.h"
#include "lens/lens_samples.h"
#include "lens/picture_frame.h"

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

    // Where the middle of the second circle is for a pixel at p, as ApertureShape counts places.
    Imath::V2d centre(const Imath::V2d &p) const { return frame_.place(p) * amount_; }
    // Whether the pixel at p sees through lens point u.
    bool passes(const Imath::V2d &u, const Imath::V2d &p) const { return within(u, centre(p)); }

    struct Columns {
        int begin = 0, end = 0;
    };
    // The pixels of [first, first + count) in row y (EXR coordinates), by their middles, that see through a lens point;
    // relative to the first.
    Columns columns(const LensSample &point, int first, int count, int y) const;

    // How much of the light is left at a pixel, [0, 1]: of that from behind focus or in front, or without these weights.
    enum class Light { behind, in_front, evenly };
    double share(Light light, const Imath::V2d &p) const;
    // The same for the pixels of a box, [row][column], to 2e-3, from a table that is made when it is first asked for.
    std::vector<double> shares(Light light, const Imath::Box2i &box) const;

    // By how much the circle's middle moves for each pixel that a lamp's light is displaced by.
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
    double share_of(Light light, const Imath::V2d &centre) const;
    double share_from(const std::vector<double> &table, const Imath::V2d &centre) const;

    std::vector<LensPoint> points_;   // of a picture: what is left is counted
    std::vector<Imath::V2d> outline_; // of others: its area is
    double reach_ = 0;                // with its middle so far away the circle leaves nothing
    mutable std::array<std::once_flag, 3> made_;
    mutable std::array<std::vector<double>, 3> tables_; // [light][angle][radius] of the circle's middle
};

} // namespace sparselens
