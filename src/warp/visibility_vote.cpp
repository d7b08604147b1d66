#include "warp/visibility_vote.h"

#include "kernels/warp_rules.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

// Counts the votes of one pixel of a view. Each sample votes by what it covers, and what the pixel leaves open looks
// past everything. A pixel that shows nothing at all does not vote, because it may not have been rendered.
void count_votes(const ViewSamples &view, std::size_t alpha, std::size_t pixel, double inverse_z,
                 double tolerance, const SeePast &past, Votes &votes) {
    if (view.pixel(pixel).empty()) return;
    double left = 1, there = 0, past_before = votes.past;
    for (const std::uint64_t i : view.pixel(pixel)) {
        const double own = double(alpha_at(view, alpha, i));
        const double covers = view.is_part(i) ? own * left : kernels::covers(own, left);
        const double nearer = 1 / double(view.z(i)) - inverse_z;
        if (std::abs(nearer) < tolerance)
            there += covers;
        else if (nearer < 0) {
            votes.past += covers;
            if (past && covers > 0) past(view, i, covers);
        }
        left -= covers;
    }
    votes.there += there;
    votes.past += left;
    votes.open += left;
    if (there > 0) votes.through += view.deep() ? votes.past - past_before : left;
}

} // namespace

Votes votes_on(const ReprojectedViews &views, const Imath::V2d &place, double inverse_z, double tolerance,
               const SeePast &past) {
    const std::size_t alpha = views.samples(0).alpha();
    Votes votes;
    for (std::size_t v = 1; v < views.size(); ++v) {
        const ViewSamples &view = views.samples(v);
        const Imath::V2d seen = views.reprojection(v).mapping().in_view(place, inverse_z);
        const Imath::Box2i &data = view.windows.data;
        if (!kernels::lies_in(seen.x, data.min.x, data.max.x)) continue;
        if (!kernels::lies_in(seen.y, data.min.y, data.max.y)) continue;
        const std::size_t pixel = view.windows.index(int(std::floor(seen.x)), int(std::floor(seen.y)));
        count_votes(view, alpha, pixel, inverse_z, tolerance, past, votes);
    }
    return votes;
}

double coverage_by_majority(const Votes &votes) {
    return kernels::coverage_by_majority(votes.there, votes.past, votes.through);
}

double coverage_by_votes(const Votes &votes, double shown) {
    return kernels::coverage_by_votes(votes.there, votes.past, votes.through, shown);
}

} // namespace sparselens
