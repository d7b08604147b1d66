#include "chain/match_doubt.h"

#include "chain/match_values.h"
#include "match/tuning.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace sparselens {

std::string doubt_of(const MatchedLens &lens, const Reduced &in, const LensFit &fit, const Evidence &evidence,
                     bool is_ambiguous) {
    if (evidence.textured < MatchTuning::least_textured)
        return "the region of the plate shows nothing to compare; choose one with texture";
    if (lens.matched_share < MatchTuning::least_matched)
        return fmt::format(
            "the plate shows something else than the LDI: {:.0f} % of the blocks match; check the "
            "shot, the frame and the region",
            100 * lens.matched_share);
    const double motion = std::hypot(fit.motion[3], fit.motion[4]);
    if (motion > MatchTuning::motion_variance)
        return fmt::format(
            "the plate is blurred by motion over about {:.0f} pixels; choose a region or a frame "
            "that stands still",
            in.by() * std::sqrt(12 * motion));
    if (lens.largest_coc < MatchTuning::all_in_focus_px)
        return "nothing in the region is out of focus, so any narrow lens fits; choose a region that is "
               "blurred";
    if (is_ambiguous)
        return "the focus may lie in front of or behind what the region shows; choose a region with more "
               "depths";
    if (certain * lens.coc_deviation > MatchTuning::widest_coc_px && lens.focus_deviation.both() > 0)
        return fmt::format(
            "the focus cannot be told: its blur is certain to {:.1f} pixels only; choose a larger "
            "region with more texture",
            certain * lens.coc_deviation);
    const double stops = 2 / std::numbers::ln2 * certain * lens.radius_deviation.both();
    if (stops > MatchTuning::widest_stops)
        return fmt::format(
            "the f-stop cannot be told: it is certain to {:.1f} stops only; choose a region with "
            "more depths, or give the f-stop and `fit=focus`",
            stops);
    if (lens.lens_radius.value > MatchTuning::widest * in.radius())
        return "the plate's lens is wider than that of the LDI; render the views with a wider lens";
    return {};
}

} // namespace sparselens
