#include "match/likely_lens.h"
#include "match/tuning.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sparselens {

namespace {

class Widening {
public:
    Widening(const Comparison &pictures, LensFit &fit)
        : pictures_(pictures), fit_(fit), best_{fit.guess, fit.likelihood} {}

    // Looks along the axes of the covariance to both sides, until other lenses fit worse. Returns the best of them, if
    // it fits better.
    std::optional<BlurGuess> widen() {
        const auto axes = axes_of(fit_.covariance, half_range(pictures_));
        LensCovariance wider{};
        for (const LensAxis &axis : axes) {
            double variance = axis.variance;
            for (const double side : {-1.0, 1.0}) variance = std::max(variance, look_along(axis, side));
            const double ends = axis.ends / half_range(pictures_);
            wider.coc += variance * axis.coc * axis.coc;
            wider.both += variance * axis.coc * ends;
            wider.scale += variance * ends * ends;
        }
        fit_.covariance = wider;
        if (best_.likelihood <= fit_.likelihood) return {};
        return best_.guess;
    }

private:
    // The variance that the likelihood has on one side of an axis: 0 if there are no lenses.
    double look_along(const LensAxis &axis, double side) {
        const double range = half_range(pictures_);
        double variance = 0;
        for (double away = MatchTuning::final_reach_px; away <= MatchTuning::farthest_px; away *= 2) {
            BlurGuess guess = fit_.guess;
            guess.coc += side * away * axis.coc;
            guess.scale += side * away * axis.ends / range;
            const LikelyLens there = softest(pictures_, {}, guess);
            const double apart =
                std::hypot(there.guess.coc - fit_.guess.coc, range * (there.guess.scale - fit_.guess.scale));
            if (apart < away / 2) break;
            LensFit other;
            other.blocks = fit_blocks(pictures_.plate, pictures_.usable, there.shown, {});
            const double worse = lead(fit_, other);
            if (there.likelihood > best_.likelihood) best_ = {there.guess, there.likelihood};
            variance = std::pow(apart / (2 * std::max(worse, 1.0)), 2);
            if (worse >= 1) break;
        }
        return variance;
    }

    struct Better {
        BlurGuess guess;
        double likelihood = 0;
    };

    const Comparison &pictures_;
    LensFit &fit_;
    Better best_;
};

} // namespace

LensFit widened(const Comparison &pictures, const KnownLens &known, LensFit fit) {
    if (known.focus || known.scale) return fit;
    if (const auto better = Widening(pictures, fit).widen()) {
        fit = measured_lens(pictures, known, *better, MatchTuning::final_lenses, MatchTuning::final_reach_px);
        Widening(pictures, fit).widen();
    }
    return fit;
}

} // namespace sparselens
