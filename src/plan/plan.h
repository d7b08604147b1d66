// What is worth rendering in addition to the centre view, derived from the centre view and the lens.
#pragma once

#include "../base/progress.h"
#include "../view/view.h"
#include "disocclusion.h"

#include <optional>
#include <string>

namespace sparselens {

struct PlanOptions {
    int views = 4;  // the largest number of views
    int margin = 2; // pixels around what the centre view misses; edges are told apart from both sides
    std::optional<double> noise = {}; // standard deviation of a pixel's noise, tone-mapped; empty: measured
    int across = 1;                   // pixels of the centre view, across and down, per pixel of the picture
};

struct PlannedView {
    Imath::V2d u; // lens point
    PixelMask mask;
    std::size_t uncovered = 0; // pixels that something nearer hides from the centre view, without the margin
};

// The pixels beyond each border from which the lens brings light inside: the largest CoC along that border.
struct OverscanNeed {
    int left = 0, top = 0, right = 0, bottom = 0;
};

struct Plan {
    std::vector<PlannedView> views; // empty: the centre view is enough
    OverscanNeed overscan;
    double noise = 0;      // mean square, tone-mapped, in the lens picture of the centre view alone (noise.h)
    std::size_t noisy = 0; // pixels of the centre view that are asked for again, as further samples
    bool full_views = false; // noise is the larger error: whole views pay as further samples
    double edges =
        0; // share of pixels of the centre view beside a jump of depth: surfaces are torn (kernels/surface.h)
    int supersample =
        1; // factor on the size at which views with the same rays pay; 1 if the centre view has sub-pixels

    double share() const; // all views together, as a share of one full view
};

// How many moments of a shutter a picture with motion blur needs (moments_needed.h).
struct MomentsNeed {
    double motion = 0; // how far things move while the shutter is open, pixels of the picture
    int moments = 1;   // 1: the blur of this motion does not show
};

// The candidates are eight or more views, spaced evenly on the rim. The even ring of `views` of them, which begins at
// the right, is taken unless others uncover noticeably more; views that add nothing are left out. `centre` stands at
// the origin.
Plan make_plan(const View &centre, const ThinLens &lens, const PlanOptions &options, Progress &progress);

} // namespace sparselens
