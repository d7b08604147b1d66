#include "match/equations.h"
#include "match/lens_search.h"
#include "match/tuning.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sparselens {

namespace {

constexpr std::size_t coc_change = 0, ends_change = 1, softness_change = 2, first_motion = 3;

// Keeps a guess within what lenses do: the focus is not beyond infinity, and where it is known, it stays.
BlurGuess allowed(BlurGuess guess, const Comparison &pictures, const KnownLens &known) {
    guess.scale = known.scale
                      ? *known.scale
                      : std::clamp(guess.scale, 0.05 * MatchTuning::narrowest_px / half_range(pictures),
                                   MatchTuning::widest * 1.5);
    guess.softness = std::clamp(guess.softness, MatchTuning::least_softness, MatchTuning::most_softness);
    const double focus =
        known.focus ? *known.focus : std::max(pictures.middle + guess.coc / guess.scale, 0.0);
    guess.coc = guess.scale * (focus - pictures.middle);
    return guess;
}

Colours difference(Colours a, const Colours &b, double step) {
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < a.rgb[k].size(); ++i)
            a.rgb[k][i] = float((double(a.rgb[k][i]) - double(b.rgb[k][i])) / step);
    return a;
}

Colours of_size(const Grid &grid) {
    const std::vector<float> plane(grid.size());
    return {grid, {plane, plane, plane}};
}

// How a picture changes if it is blurred more along x than along y, and along the falling diagonal.
std::pair<Colours, Colours> motion_changes(const Colours &of) {
    Colours along = of_size(of.grid), across = along;
    const Imath::Box2i box = of.grid.box();
    for (std::size_t k = 0; k < 3; ++k)
        for (int y = box.min.y; y <= box.max.y; ++y)
            for (int x = box.min.x; x <= box.max.x; ++x) {
                const auto at = [&](int dx, int dy) {
                    return of.rgb[k][of.grid.index(std::clamp(x + dx, box.min.x, box.max.x),
                                                   std::clamp(y + dy, box.min.y, box.max.y))];
                };
                const std::size_t i = of.grid.index(x, y);
                along.rgb[k][i] = (at(1, 0) + at(-1, 0) - at(0, 1) - at(0, -1)) / 4;
                across.rgb[k][i] = (at(1, 1) + at(-1, -1) - at(1, -1) - at(-1, 1)) / 8;
            }
    return {std::move(along), std::move(across)};
}

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
        for (int step = 0; step < steps && reach >= MatchTuning::settled_px; ++step) {
            const BlurGuess before = best.guess;
            Likely better = best;
            slopes = slopes_at(best, reach, better);
            const Changes by = step_of(blocks_at(best, slopes));
            for (const double share : {1.0, 0.5}) {
                const Likely there = softest(moved(before, share * by[coc_change], share * by[ends_change],
                                                   before.softness + share * by[softness_change]));
                keep_better(better, there);
                if (there.likelihood > best.likelihood) break;
            }
            best = std::move(better);
            if (distance(before, best.guess) < MatchTuning::same_reach * reach) reach /= 2;
        }
        return fit_at(best, slopes);
    }

private:
    static void keep_better(Likely &best, const Likely &other) {
        if (other.likelihood > best.likelihood) best = other;
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
        Slopes slopes{of_size(at.linear.grid), of_size(at.linear.grid)};
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

} // namespace sparselens
