// Finds where the pixels of a rim view lie in the centre view.
#pragma once

#include "deep/view_samples.h"
#include "view/view_mapping.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// A pixel of a view at its position in the centre view.
struct ReprojectedSample {
    int x, y;             // the pixel of the centre view, EXR coordinates
    float dx, dy;         // offset from that pixel's centre, [-1/2, 1/2], y down
    float inverse_z;      // 1 / planar depth
    std::uint32_t source; // index of the view's sample
};

class Reprojection {
public:
    // The samples of the view lie at the pixel centres, at depths above 0. The view must outlive the reprojection.
    Reprojection(const ViewSamples &view, const ViewMapping &mapping);

    // A box that contains all pixels into which samples fall.
    Imath::Box2i reach() const;

    // Whether samples of a source row, counted from the top, may fall into those rows.
    bool may_reach(std::size_t row, int first_row, int last_row) const {
        return !(reach_[row].max.y < first_row || reach_[row].min.y >= last_row + 1);
    }

    // Appends every sample that falls into the rows [first_row, last_row], pixel by pixel of the view.
    void append_rows(int first_row, int last_row, std::vector<ReprojectedSample> &out) const;

    const ViewMapping &mapping() const { return mapping_; }

private:
    const ViewSamples &view_;
    ViewMapping mapping_;
    std::vector<Imath::Box2d> reach_; // of each source row: a box around the positions of its samples
};

} // namespace sparselens
