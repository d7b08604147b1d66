#include "match/lens_search.h"

#include "match/tone_curve.h"
#include "match/tuning.h"

#include <algorithm>
#include <cmath>

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

} // namespace sparselens
