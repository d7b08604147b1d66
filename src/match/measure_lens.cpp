#include "match/measure_lens.h"

#include "match/equations.h"
#include "match/tuning.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace sparselens {

namespace {

constexpr std::size_t coc_change = 0, ends_change = 1, first_motion = 3;

std::vector<BlockFit> blocks_at(const Comparison &pictures, const LikelyLens &at, const Slopes &slopes) {
    const double softness = at.guess.softness;
    const double less = std::max(softness - MatchTuning::softness_step, MatchTuning::least_softness),
                 more = softness + MatchTuning::softness_step;
    auto [along, across] = motion_changes(at.shown);
    const std::vector<Colours> changes{
        slopes.by_coc, slopes.by_ends,
        difference(as_plate(pictures, at.linear, more), as_plate(pictures, at.linear, less), more - less),
        std::move(along), std::move(across)};
    return fit_blocks(pictures.plate, pictures.usable, at.shown, changes);
}

} // namespace

LensFit fit_with(const Comparison &pictures, const KnownLens &known, const LikelyLens &at,
                 const Slopes &slopes) {
    LensFit fit;
    fit.guess = at.guess;
    fit.shown = at.shown;
    fit.blocks = blocks_at(pictures, at, slopes);
    fit.likelihood = likelihood_of(fit.blocks);
    std::array<bool, most_changes> is_free;
    is_free.fill(true);
    is_free[coc_change] = !known.focus;
    is_free[ends_change] = !known.scale;
    fit.motion = solve_blocks(fit.blocks, is_free).by;
    is_free[first_motion] = is_free[first_motion + 1] = false; // no lens makes it
    const Matrix spread = solve_blocks(fit.blocks, is_free).covariance;
    const double per_end = 1 / half_range(pictures);
    fit.covariance = {spread[coc_change][coc_change], per_end * spread[coc_change][ends_change],
                      per_end * per_end * spread[ends_change][ends_change]};
    return fit;
}

} // namespace sparselens
