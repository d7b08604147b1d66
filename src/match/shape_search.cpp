#include "match/shape_search.h"

#include "match/tuning.h"

#include <cmath>
#include <limits>

namespace sparselens {

namespace {

// The angle after which a regular polygon is the same again, degrees.
double period(const ApertureShape &shape) { return 360.0 / shape.blades; }

class ShapeSearch {
public:
    ShapeSearch(const Comparison &pictures, const ShapedGather &gather, const KnownLens &known)
        : pictures_(pictures), gather_(gather), known_(known) {}

    LensFit refined(const ApertureShape &shape, const BlurGuess &guess) const {
        Comparison shaped = pictures_;
        shaped.gather = [&](double coc, double scale, bool exactly) {
            return gather_(shape, coc, scale, exactly);
        };
        return refine_lens(shaped, known_, guess, MatchTuning::shape_lenses, MatchTuning::final_reach_px);
    }

    // How well a shape fits at this guess.
    double likelihood(const ApertureShape &shape, const BlurGuess &guess) const {
        const Rgb shown = as_plate(pictures_, gather_(shape, guess.coc, guess.scale, true), guess.softness);
        return likelihood_of(fit_blocks(pictures_.plate, pictures_.usable, shown, {}));
    }

    // The guess at which the CoC of shape `to` has the area that `from` has at `guess`. A known radius stays.
    BlurGuess at_equal_area(BlurGuess guess, const ApertureShape &from, const ApertureShape &to) const {
        const double factor = std::sqrt(area_of(from) / area_of(to));
        guess.coc *= factor;
        if (!known_.scale) guess.scale *= factor;
        return guess;
    }

    struct Candidate {
        ApertureShape shape;
        BlurGuess guess;
        double likelihood = 0;
    };

    Candidate tried(const ApertureShape &shape, const BlurGuess &guess, const ApertureShape &of_guess) const {
        const BlurGuess there = at_equal_area(guess, of_guess, shape);
        return {shape, there, likelihood(shape, there)};
    }

    // Compares each squeeze at the lens that fits it best, which is not the best round lens.
    Candidate best_squeeze(const BlurGuess &round) const {
        Candidate best{{}, round, likelihood({}, round)};
        for (const double squeeze : MatchTuning::squeezes) {
            const ApertureShape shape{.squeeze = squeeze};
            const LensFit fit = refined(shape, at_equal_area(round, {}, shape));
            keep_better(best, {shape, fit.guess, fit.likelihood});
        }
        return best;
    }

    // The best polygon with the squeeze of `round`.
    Candidate best_blades(const ApertureShape &round, const BlurGuess &guess) const {
        Candidate best;
        best.likelihood = -std::numeric_limits<double>::infinity();
        for (int blades = MatchTuning::fewest_blades; blades <= MatchTuning::most_blades; ++blades)
            for (int i = 0; i < MatchTuning::rotations; ++i) {
                ApertureShape shape = round;
                shape.blades = blades;
                shape.rotation = i * period(shape) / MatchTuning::rotations;
                keep_better(best, tried(shape, guess, round));
            }
        for (double step = period(best.shape) / MatchTuning::rotations / 2; step > MatchTuning::finest_turn;
             step /= 2) {
            const Candidate middle = best;
            for (const double turn : {-step, step}) {
                ApertureShape shape = middle.shape;
                shape.rotation += turn;
                keep_better(best, tried(shape, middle.guess, middle.shape));
            }
        }
        best.shape.rotation = std::remainder(best.shape.rotation, period(best.shape));
        return best;
    }

private:
    static void keep_better(Candidate &best, const Candidate &other) {
        if (other.likelihood > best.likelihood) best = other;
    }

    const Comparison &pictures_;
    const ShapedGather &gather_;
    const KnownLens &known_;
};

} // namespace

ShapeFit find_shape(const Comparison &pictures, const ShapedGather &gather, const KnownLens &known,
                    const BlurGuess &round) {
    const ShapeSearch search(pictures, gather, known);
    ShapeFit best{{}, search.refined({}, round), false};
    const auto consider = [&](const auto &candidate) {
        if (candidate.shape == best.shape) return;
        LensFit fit = search.refined(candidate.shape, candidate.guess);
        const double by = lead(fit, best.fit);
        best.is_told = best.is_told || std::abs(by) >= MatchTuning::shape_lead;
        if (by >= MatchTuning::shape_lead) best = {candidate.shape, std::move(fit), true};
    };
    consider(search.best_squeeze(best.fit.guess));
    consider(search.best_blades(best.shape, best.fit.guess));
    return best;
}

} // namespace sparselens
