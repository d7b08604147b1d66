// What is worth rendering besides the centre view, told from the centre view and the lens.
#pragma once

#include "../base/progress.h"
#include "../view/view.h"
#include "disocclusion.h"

#include <optional>
#include <string>

namespace sparselens {

struct PlanOptions {
    int views = 4;  // at most so many
    int margin = 2; // pixels around what the centre view does not see: edges are told apart from both sides
    std::optional<double> noise = {}; // standard deviation of a pixel's noise, tone-mapped; empty: measured
};

struct PlannedView {
    Imath::V2d u; // lens point
    PixelMask mask;
    std::size_t uncovered = 0; // pixels that something nearer hides from the centre view, margin not counted
};

// Pixels beyond each edge of the frame from which the lens brings light inside: the largest CoC along the edge.
struct OverscanNeed {
    int left = 0, top = 0, right = 0, bottom = 0;
};

struct Plan {
    std::vector<PlannedView> views; // none: the centre view is enough
    OverscanNeed overscan;
    double noise = 0; // mean square, tone-mapped, in the lens picture of the centre view alone (noise.h)
    bool full_views = false; // noise is the larger error: whole views pay as further samples

    double share() const; // of one full view, all views together
};

// Candidate views stand evenly on the rim, eight or more; of them the even ring of `views` is taken, from the right
// on, unless others uncover noticeably more; and those that add nothing are left out. `centre` stands at the origin.
Plan make_plan(const View &centre, const ThinLens &lens, const PlanOptions &options, Progress &progress);

} // namespace sparselens
