// Where the pixels of a rim view lie in the centre view: p = q + (F / z) (X, -Y) for a camera moved by (X, Y)
// with parallel axes (design.md section 1). Points at infinity stay where they are.
#pragma once

#include "ldi/ldi.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// One view pixel at its place in the centre view.
struct ReprojectedSample {
    int x, y;             // centre pixel it falls in, EXR coordinates
    float dx, dy;         // offset from that pixel's centre, [-1/2, 1/2], y down
    float inverse_z;      // 1 / planar depth
    std::uint32_t source; // index into the view's samples
};

class Reprojection {
public:
    // `position` of the view's camera, scene units; focal_px: focal length in pixels. The view's samples lie at
    // the pixel centres; it must outlive the reprojection.
    Reprojection(const Ldi &view, const Imath::V2d &position, double focal_px);

    // A box that holds all pixels in which samples fall.
    Imath::Box2i reach() const;

    // Appends every sample that falls in rows [first_row, last_row], in source order.
    void append_rows(int first_row, int last_row, std::vector<ReprojectedSample> &out) const;

    // Where the view shows what the centre view shows at p at depth 1 / inverse_z; pixels, both.
    Imath::V2d source_of(const Imath::V2d &p, double inverse_z) const {
        return {p.x - shift_x_ * inverse_z, p.y - shift_y_ * inverse_z};
    }

private:
    // By how much the samples of a source row may move, pixels: left <= 0 <= right, up <= 0 <= down.
    struct RowReach {
        double left, right, up, down;
    };

    const Ldi &view_;
    double shift_x_, shift_y_; // pixels times scene units: divided by z they are a displacement
    std::vector<RowReach> reach_;
};

} // namespace sparselens
