#include "match/equations.h"
#include "match/lens_search.h"
#include "match/tuning.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace sparselens {

namespace {

constexpr std::size_t coc_change = 0, ends_change = 1, softness_change = 2, first_motion = 3;

// A guess and its pictures: as gathered, and as the plate shows them.
struct Likely {
    BlurGuess guess;
    double likelihood = 0;
    Colours linear, shown;
};

class Refining {
public:
    Refining(const Comparison &pictures, const KnownLens &known) : pictures_(pictures), known_(known) {
        is_free_.fill(true);
        is_free_[coc_change] = !known.focus;
        is_free_[ends_change] = !known.scale;
    }

    // Gauss-Newton steps. Their derivatives are differences of pictures that lie apart, and the best of all pictures
    // counts, so the small steps that gathered pictures make, for example where the number of their lens points
    // changes, do not stop the search.
    LensFit from(const BlurGuess &guess, int steps, double reach) const {
        Likely best = softest(guess);
        Slopes slopes;
        for (int step = 0; step < steps; ++step) {
            const BlurGuess before = best.guess;
            Likely better = best;
            slopes = slopes_at(best, reach, better);
            keep_better(better, along(best, step_of(blocks_at(best, slopes))));
            const double length = distance(before, better.guess);
            if (length > 0) keep_better(better, along(better, change(before, better.guess)));
            best = std::move(better);
            if (reach <= MatchTuning::settled_px && length < MatchTuning::gather_coc_px) break;
            if (length < MatchTuning::same_reach * reach)
                reach = std::max(reach / 2, MatchTuning::settled_px);
        }
        return fit_at(best, slopes);
    }

    // Looks along the axes of the covariance to both sides, until other lenses fit worse. Returns the best of them, if
    // it fits better.
    std::optional<BlurGuess> widen(LensFit &fit) const {
        const Likely at = softest(fit.guess);
        Likely better = at;
        fit = fit_at(at, slopes_at(at, MatchTuning::final_reach_px, better));
        const auto axes = axes_of(fit.covariance, half_range(pictures_));
        LensCovariance wider{};
        for (const LensAxis &axis : axes) {
            double variance = axis.variance;
            for (const double side : {-1.0, 1.0})
                variance = std::max(variance, look_along(fit, axis, side, better));
            const double ends = axis.ends / half_range(pictures_);
            wider.coc += variance * axis.coc * axis.coc;
            wider.both += variance * axis.coc * ends;
            wider.scale += variance * ends * ends;
        }
        fit.covariance = wider;
        if (better.likelihood <= at.likelihood) return {};
        return better.guess;
    }

private:
    // The variance that the likelihood has on one side of an axis: 0 if there are no lenses.
    double look_along(const LensFit &fit, const LensAxis &axis, double side, Likely &better) const {
        double variance = 0;
        for (double away = MatchTuning::final_reach_px; away <= MatchTuning::farthest_px; away *= 2) {
            const Likely there = softest(
                moved(fit.guess, side * away * axis.coc, side * away * axis.ends, fit.guess.softness));
            const double apart = std::hypot(there.guess.coc - fit.guess.coc,
                                            half_range(pictures_) * (there.guess.scale - fit.guess.scale));
            if (apart < away / 2) break;
            keep_better(better, there);
            LensFit other;
            other.blocks = fit_blocks(pictures_.plate, pictures_.usable, there.shown, {});
            const double worse = lead(fit, other);
            variance = std::pow(apart / (2 * std::max(worse, 1.0)), 2);
            if (worse >= 1) break;
        }
        return variance;
    }

    // The step from one guess to another.
    Changes change(const BlurGuess &from, const BlurGuess &to) const {
        Changes by{};
        by[coc_change] = to.coc - from.coc;
        by[ends_change] = half_range(pictures_) * (to.scale - from.scale);
        by[softness_change] = to.softness - from.softness;
        return by;
    }

    static void keep_better(Likely &best, const Likely &other) {
        if (other.likelihood > best.likelihood) best = other;
    }

    // The best picture along a step. Noise of the gathered pictures, which their differences have too, makes steps many
    // times too short, so a step is doubled as long as that helps; and it is halved if it does not help.
    Likely along(const Likely &from, const Changes &by) const {
        const auto there = [&](double share) {
            return softest(moved(from.guess, share * by[coc_change], share * by[ends_change],
                                 from.guess.softness + share * by[softness_change]));
        };
        Likely best = there(1);
        if (best.likelihood <= from.likelihood) return there(0.5);
        for (double share = 2; share <= MatchTuning::longest_share; share *= 2) {
            Likely next = there(share);
            if (next.likelihood <= best.likelihood) break;
            best = std::move(next);
        }
        return best;
    }

    // `x` changes the CoC at the middle depth, `y` that at the ends of the range of depths, both in pixels.
    BlurGuess moved(BlurGuess guess, double x, double y, double softness) const {
        guess.coc += x;
        guess.scale = std::max(guess.scale + y / half_range(pictures_), 0.4 * guess.scale);
        guess.softness = softness;
        return allowed(guess, pictures_, known_);
    }

    double distance(const BlurGuess &a, const BlurGuess &b) const {
        return std::max(std::abs(a.coc - b.coc), half_range(pictures_) * std::abs(a.scale - b.scale));
    }

    double likelihood(const Colours &shown) const {
        return likelihood_of(fit_blocks(pictures_.plate, pictures_.usable, shown, {}));
    }

    Likely compared(BlurGuess guess) const {
        guess = allowed(guess, pictures_, known_);
        Likely result{guess, 0, pictures_.gather(guess.coc, guess.scale, true), {}};
        result.shown = as_plate(pictures_, result.linear, guess.softness);
        result.likelihood = likelihood(result.shown);
        return result;
    }

    // The same, with the softness that fits best, which needs no other gathered picture.
    Likely softest(const BlurGuess &guess) const {
        Likely best = compared(guess);
        for (double step = MatchTuning::softness_step * (1 + best.guess.softness);
             step > MatchTuning::softness_step / 4; step /= 2) {
            const double middle = best.guess.softness;
            for (const double by : {-step, step}) {
                const double softness =
                    std::clamp(middle + by, MatchTuning::least_softness, MatchTuning::most_softness);
                Colours shown = as_plate(pictures_, best.linear, softness);
                const double there = likelihood(shown);
                if (there <= best.likelihood) continue;
                best.likelihood = there;
                best.guess.softness = softness;
                best.shown = std::move(shown);
            }
        }
        return best;
    }

    // How the picture changes with the CoC at the middle depth and at the ends.
    struct Slopes {
        Colours by_coc, by_ends;
    };

    // From guesses `reach` pixels away to both sides. `better`: the best of all that were compared.
    Slopes slopes_at(const Likely &at, double reach, Likely &better) const {
        const auto slope = [&](double x, double y) {
            const Likely more = compared(moved(at.guess, x, y, at.guess.softness)),
                         less = compared(moved(at.guess, -x, -y, at.guess.softness));
            keep_better(better, more);
            keep_better(better, less);
            const double apart = x != 0 ? more.guess.coc - less.guess.coc
                                        : (more.guess.scale - less.guess.scale) * half_range(pictures_);
            return difference(more.shown, less.shown, std::max(apart, 1e-6));
        };
        Slopes slopes{black(at.linear.grid), black(at.linear.grid)};
        if (is_free_[coc_change]) slopes.by_coc = slope(reach, 0);
        if (is_free_[ends_change]) slopes.by_ends = slope(0, reach);
        return slopes;
    }

    std::vector<BlockFit> blocks_at(const Likely &at, const Slopes &slopes) const {
        const double softness = at.guess.softness;
        const double less = std::max(softness - MatchTuning::softness_step, MatchTuning::least_softness),
                     more = softness + MatchTuning::softness_step;
        auto [along, across] = motion_changes(at.shown);
        const std::vector<Colours> changes{slopes.by_coc, slopes.by_ends,
                                           difference(as_plate(pictures_, at.linear, more),
                                                      as_plate(pictures_, at.linear, less), more - less),
                                           std::move(along), std::move(across)};
        return fit_blocks(pictures_.plate, pictures_.usable, at.shown, changes);
    }

    // All but motion, which no lens makes.
    Solution lens_of(const std::vector<BlockFit> &blocks) const {
        auto is_free = is_free_;
        is_free[first_motion] = is_free[first_motion + 1] = false;
        return solve_blocks(blocks, is_free);
    }

    Changes step_of(const std::vector<BlockFit> &blocks) const {
        Changes by = lens_of(blocks).by;
        const double far =
            std::max(std::abs(by[coc_change]), std::abs(by[ends_change])) / MatchTuning::farthest_px;
        if (far > 1)
            for (double &v : by) v /= far;
        return by;
    }

    LensFit fit_at(const Likely &at, const Slopes &slopes) const {
        LensFit fit;
        fit.guess = at.guess;
        fit.shown = at.shown;
        fit.blocks = blocks_at(at, slopes);
        fit.likelihood = likelihood_of(fit.blocks);
        fit.motion = solve_blocks(fit.blocks, is_free_).by;
        const Matrix spread = lens_of(fit.blocks).covariance;
        const double per_end = 1 / half_range(pictures_);
        fit.covariance = {spread[coc_change][coc_change], per_end * spread[coc_change][ends_change],
                          per_end * per_end * spread[ends_change][ends_change]};
        return fit;
    }

    const Comparison &pictures_;
    const KnownLens &known_;
    std::array<bool, most_changes> is_free_{};
};

} // namespace

LensFit refine_lens(const Comparison &pictures, const KnownLens &known, BlurGuess guess, int steps,
                    double reach_px) {
    return Refining(pictures, known).from(guess, steps, reach_px);
}

LensFit widened(const Comparison &pictures, const KnownLens &known, LensFit fit) {
    if (known.focus || known.scale) return fit;
    const Refining refining(pictures, known);
    if (const auto better = refining.widen(fit)) {
        fit = refining.from(*better, MatchTuning::final_steps, MatchTuning::final_reach_px);
        refining.widen(fit);
    }
    return fit;
}

} // namespace sparselens
