#include "match/lens_search.h"

#include "match/measure_lens.h"
#include "match/tone_curve.h"
#include "match/tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace sparselens {

namespace {

struct Scored {
    BlurGuess guess;
    double likelihood;
};

// The sizes of lenses to look with.
std::vector<double> scales(const Comparison &pictures, const KnownLens &known) {
    if (known.scale) return {*known.scale};
    std::vector<double> result;
    const double narrowest = std::min(MatchTuning::narrowest_px / half_range(pictures), 0.7);
    for (double scale = MatchTuning::widest; scale > narrowest; scale /= 1.4) result.push_back(scale);
    return result;
}

// The distances of the focus to look at, as CoC at the middle depth.
std::vector<double> cocs(const Comparison &pictures, const KnownLens &known, double scale) {
    if (known.focus) return {scale * (*known.focus - pictures.middle)};
    const double range = half_range(pictures) * scale,
                 step = std::max(MatchTuning::search_step, 2 * range * MatchTuning::search_share);
    const double nearest = 1.4 * range + 3, farthest = -std::min(nearest, scale * pictures.middle);
    std::vector<double> result;
    for (double coc = farthest; coc < nearest + step; coc += step) result.push_back(coc);
    return result;
}

} // namespace

double half_range(const Comparison &pictures) { return std::max((pictures.near - pictures.far) / 2, 0.5); }

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

Rgb as_plate(const Comparison &pictures, const Rgb &gathered, double softness) {
    return with_curve_of(pictures.colours, pictures.usable, tone_mapped(softened(gathered, softness)));
}

double likelihood_of(const std::vector<BlockFit> &blocks) {
    double sum = 0;
    for (const BlockFit &block : blocks) sum += block.likelihood;
    return sum;
}

std::vector<BlurGuess> search_lens(const Comparison &pictures, const KnownLens &known) {
    std::vector<Scored> scored;
    for (const double scale : scales(pictures, known))
        for (const double coc : cocs(pictures, known, scale)) {
            const Rgb linear = pictures.gather(coc, scale, false);
            for (const double softness : {0.15, 1.0}) {
                const Rgb shown = as_plate(pictures, linear, softness);
                scored.push_back({{coc, scale, softness},
                                  likelihood_of(fit_blocks(pictures.plate, pictures.usable, shown, {}))});
            }
        }
    std::ranges::stable_sort(scored,
                             [](const Scored &a, const Scored &b) { return a.likelihood > b.likelihood; });
    const double range = half_range(pictures);
    const auto is_near = [&](const BlurGuess &a, const BlurGuess &b) {
        return std::abs(a.coc - b.coc) + range * std::abs(a.scale - b.scale) <
               MatchTuning::steps_apart * MatchTuning::search_step;
    };
    std::vector<BlurGuess> chosen;
    for (const Scored &one : scored) {
        if (chosen.size() == MatchTuning::refined_guesses) break;
        if (std::ranges::none_of(chosen, [&](const BlurGuess &c) { return is_near(c, one.guess); }))
            chosen.push_back(one.guess);
    }
    return chosen;
}

std::array<LensAxis, 2> axes_of(const LensCovariance &covariance, double half_range) {
    const double coc = covariance.coc, both = half_range * covariance.both,
                 ends = half_range * half_range * covariance.scale;
    const double turn = 0.5 * std::atan2(2 * both, coc - ends), middle = (coc + ends) / 2,
                 more = std::hypot((coc - ends) / 2, both);
    return {LensAxis{std::cos(turn), std::sin(turn), middle + more},
            LensAxis{-std::sin(turn), std::cos(turn), std::max(middle - more, 0.0)}};
}

double lead(const LensFit &a, const LensFit &b) {
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < a.blocks.size(); ++i) {
        const double more = a.blocks[i].likelihood - b.blocks[i].likelihood;
        sum += more;
        squares += more * more;
    }
    return squares > 0 ? sum / std::sqrt(squares) : 0;
}

namespace {

// Searches for the likeliest lens: fits a quadratic function to the likelihoods of the lenses within reach of the best
// one so far, and compares the lens at which this function is highest. If that is no better, the reach is halved (a
// trust region). The derivatives of pictures are not used: noise of gathered pictures makes their steps too short,
// above all along the ridge on which a narrower lens is about as likely as a softer plate.
class Refining {
public:
    Refining(const Comparison &pictures, const KnownLens &known, const BlurGuess &guess, double reach)
        : pictures_(pictures), known_(known), reach_(reach), tried_{softest(pictures, known, guess)} {}

    const LikelyLens &best_of(int lenses) {
        while (reach_ >= MatchTuning::settled_px && int(tried_.size()) < lenses) {
            if (const auto guess = unlike_others())
                look(*guess);
            else
                go();
        }
        return best();
    }

    // The slopes of the quadratic functions of every pixel.
    Slopes slopes() {
        reach_ = std::max(reach_, MatchTuning::settled_px);
        while (near_best() < quadratic_terms && reach_ < MatchTuning::farthest_px) reach_ *= 2;
        std::vector<Place> places;
        std::vector<Rgb> shown;
        for (const LikelyLens &one : tried_)
            if (is_near(one)) {
                places.push_back(place_of(one.guess));
                shown.push_back(as_plate(pictures_, one.linear, best().guess.softness));
            }
        const Quadratic model(places, place_of(best().guess), reach_);
        const std::span<const double> by_coc = model.shares(1);
        std::vector<double> by_ends(model.shares(2).begin(), model.shares(2).end());
        if (known_.focus) // the CoC at the middle depth changes with the radius
            for (std::size_t p = 0; p < by_ends.size(); ++p)
                by_ends[p] += (*known_.focus - pictures_.middle) / half_range(pictures_) * by_coc[p];
        return {slope(by_coc, shown), slope(by_ends, shown)};
    }

private:
    const LikelyLens &best() const { return tried_[best_]; }

    Rgb slope(std::span<const double> shares, std::span<const Rgb> shown) const {
        Rgb result = black(best().shown.grid);
        for (std::size_t p = 0; p < shown.size(); ++p)
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t i = 0; i < result.rgb[k].size(); ++i)
                    result.rgb[k][i] += float(shares[p] / reach_ * double(shown[p].rgb[k][i]));
        return result;
    }

    // The CoC at the middle depth, and by how much it differs at the ends of the range of depths.
    Place place_of(const BlurGuess &guess) const { return {guess.coc, half_range(pictures_) * guess.scale}; }

    BlurGuess guess_at(const Place &place) const {
        return allowed({place.x, place.y / half_range(pictures_), best().guess.softness}, pictures_, known_);
    }

    bool is_near(const LikelyLens &one) const {
        return distance(place_of(one.guess), place_of(best().guess)) < MatchTuning::model_reaches * reach_;
    }

    std::size_t near_best() const {
        return std::size_t(
            std::ranges::count_if(tried_, [&](const LikelyLens &one) { return is_near(one); }));
    }

    double to_nearest(const BlurGuess &guess) const {
        double least = std::numeric_limits<double>::infinity();
        for (const LikelyLens &one : tried_)
            least = std::min(least, distance(place_of(guess), place_of(one.guess)));
        return least;
    }

    // If too few lenses around the best one are known for a quadratic function: one that is least like the others.
    std::optional<BlurGuess> unlike_others() const {
        if (near_best() >= quadratic_terms) return {};
        const Place middle = place_of(best().guess);
        BlurGuess farthest;
        double most = 0;
        for (int i = 0; i < 8; ++i) {
            const double angle = std::numbers::pi / 4 * i;
            const BlurGuess there =
                guess_at({middle.x + reach_ * std::cos(angle), middle.y + reach_ * std::sin(angle)});
            if (const double far = to_nearest(there); far > most) {
                most = far;
                farthest = there;
            }
        }
        if (most < reach_ / 2) return {}; // the other lenses are not allowed
        return farthest;
    }

    void look(const BlurGuess &guess) {
        tried_.push_back(softest(pictures_, known_, guess));
        if (tried_.back().likelihood > best().likelihood) best_ = tried_.size() - 1;
    }

    // Goes to where the quadratic function is highest.
    void go() {
        std::vector<Place> places;
        std::vector<double> likelihoods;
        for (const LikelyLens &one : tried_)
            if (is_near(one)) {
                places.push_back(place_of(one.guess));
                likelihoods.push_back(one.likelihood);
            }
        const Place from = place_of(best().guess);
        const BlurGuess to = guess_at(Quadratic(places, from, reach_).best(likelihoods));
        if (to_nearest(to) < MatchTuning::new_share * reach_) {
            reach_ /= 2;
            return;
        }
        const std::size_t before = best_;
        look(to);
        if (best_ == before) reach_ /= 2;
    }

    const Comparison &pictures_;
    const KnownLens &known_;
    double reach_;
    std::vector<LikelyLens> tried_;
    std::size_t best_ = 0; // in `tried_`
};

} // namespace

LensFit refine_lens(const Comparison &pictures, const KnownLens &known, const BlurGuess &guess, int lenses,
                    double reach_px) {
    Refining refining(pictures, known, guess, reach_px);
    const LikelyLens &best = refining.best_of(lenses);
    LensFit fit;
    fit.guess = best.guess;
    fit.likelihood = best.likelihood;
    fit.blocks = fit_blocks(pictures.plate, pictures.usable, best.shown, {});
    fit.shown = best.shown;
    return fit;
}

LensFit measured_lens(const Comparison &pictures, const KnownLens &known, const BlurGuess &guess, int lenses,
                      double reach_px) {
    Refining refining(pictures, known, guess, reach_px);
    const LikelyLens &best = refining.best_of(lenses);
    return fit_with(pictures, known, best, refining.slopes());
}

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
    // The variance that the likelihoods of lenses on one side of an axis imply; 0 if no lens there is allowed.
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
