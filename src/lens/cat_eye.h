// What a second circle leaves of the aperture away from the optical axis (LensLooks::cat_eye).
#pragma once

#include "lens/aperture.h"
#include "lens/lens_looks.h"
#include "lens/lens_samples.h"
#include "lens/picture_frame.h"

#include <Imath/ImathBox.h>

#include <vector>

namespace sparselens {

class CatEye {
public:
    CatEye(const Aperture &aperture, const LensLooks &looks, const PictureFrame &frame);

    bool cuts() const { return amount_ > 0; }
    bool darkens() const { return darkens_; }

    // Where the middle of the second circle is for a pixel at p, as ApertureShape counts places.
    Imath::V2d centre(const Imath::V2d &p) const { return frame_.place(p) * amount_; }
    // Whether the pixel at p sees through lens point u.
    bool passes(const Imath::V2d &u, const Imath::V2d &p) const {
        const Imath::V2d off = Imath::V2d(u.x * aperture_.shape().squeeze, u.y) - centre(p);
        return off.dot(off) <= 1;
    }

    struct Columns {
        int begin = 0, end = 0;
    };
    // The pixels of [first, first + count) in row y (EXR coordinates), by their middles, that see through a lens point;
    // relative to the first.
    Columns columns(const LensSample &point, int first, int count, int y) const;

    // How much of the light from behind focus or in front is left at a pixel, [0, 1].
    double share(bool behind, const Imath::V2d &p) const;
    // The same for the pixels of a box, [row][column], to 1e-3: every eighth pixel, and between these bilinear.
    std::vector<double> shares(bool behind, const Imath::Box2i &box) const;

    // By how much the circle's middle moves for each pixel that a lamp's light is displaced by.
    double shift_per_pixel() const { return amount_ / frame_.half_diagonal; }

private:
    const Aperture &aperture_;
    double amount_;
    bool darkens_;
    PictureFrame frame_;
    std::vector<LensPoint> points_; // of a picture: what is left is counted
};

} // namespace sparselens
