#include "match/likely_lens.h"

#include "match/tuning.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sparselens {

namespace {

struct Softness {
    double value = 0, likelihood = 0;
};

// Where the parabola through three points is highest; they are in order, and the second is the highest.
double highest_of(const Softness &a, const Softness &b, const Softness &c) {
    const double left = (b.likelihood - a.likelihood) / (b.value - a.value),
                 right = (c.likelihood - b.likelihood) / (c.value - b.value);
    const double bend = (right - left) / (c.value - a.value);
    return bend < 0 ? (a.value + b.value) / 2 - left / (2 * bend) : b.value;
}

} // namespace

LikelyLens compared(const Comparison &pictures, const KnownLens &known, const BlurGuess &guess) {
    const BlurGuess by = allowed(guess, pictures, known);
    LikelyLens result{by, 0, pictures.gather(by.coc, by.scale, true), {}};
    result.shown = as_plate(pictures, result.linear, by.softness);
    result.likelihood = likelihood_of(fit_blocks(pictures.plate, pictures.usable, result.shown, {}));
    return result;
}

LikelyLens softest(const Comparison &pictures, const KnownLens &known, const BlurGuess &guess) {
    LikelyLens best = compared(pictures, known, guess);
    const auto look = [&](double softness) {
        const Softness at{std::clamp(softness, MatchTuning::least_softness, MatchTuning::most_softness), 0};
        Rgb shown = as_plate(pictures, best.linear, at.value);
        const double there = likelihood_of(fit_blocks(pictures.plate, pictures.usable, shown, {}));
        if (there > best.likelihood) {
            best.likelihood = there;
            best.guess.softness = at.value;
            best.shown = std::move(shown);
        }
        return Softness{at.value, there};
    };
    // Goes up, with growing steps, until the highest point lies between two others.
    double step = MatchTuning::softness_step * (1 + std::max(best.guess.softness, 0.0));
    Softness middle{best.guess.softness, best.likelihood}, before = look(middle.value - step),
                                                           after = look(middle.value + step);
    if (before.likelihood > middle.likelihood) {
        std::swap(before, after);
        step = -step;
    }
    while (after.likelihood > middle.likelihood) {
        before = std::exchange(middle, after);
        after = look(middle.value + (step *= 2));
    }
    if (before.value != middle.value && after.value != middle.value) look(highest_of(before, middle, after));
    return best;
}

} // namespace sparselens
