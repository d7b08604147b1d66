#include "match/measure_lens.h"
#include "match/quadratic.h"
#include "match/tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

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

} // namespace sparselens
