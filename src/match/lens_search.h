// Finds the lens whose gathered picture is blurred as a plate is.
//
// The CoC is a linear function of disparity P (lens/thin_lens.h): c(P) = coc - scale (P - middle). The
// search compares gathered pictures over a grid of both numbers, then goes uphill from the best ones.
#pragma once

#include "match/blocks.h"

#include <array>
#include <functional>
#include <optional>

namespace sparselens {

// What is searched for, in pixels of the compared pictures.
struct BlurGuess {
    double coc = 0;        // signed CoC at the middle depth
    double scale = 1;      // radius of the lens, relative to that of the LDI, > 0
    double softness = 0.3; // of the whole plate: variance, square pixels
};

// Two pictures to compare, and the depths that they show.
struct Comparison {
    Rgb colours;                          // of the plate, tone-mapped
    Grey plate;                           // their brightness
    std::vector<std::uint8_t> usable;     // [pixel]
    double near = 0, middle = 0, far = 0; // disparities for scale 1, pixels
    // The gathered picture, scene-linear; `exactly`, or quickly with more noise.
    std::function<Rgb(double coc, double scale, bool exactly)> gather;
};

// Values that are known beforehand.
struct KnownLens {
    std::optional<double> focus = {}; // its disparity for scale 1, pixels
    std::optional<double> scale = {};
};

// Half the range of disparities, at least half a pixel.
double half_range(const Comparison &pictures);

// Keeps a guess within what lenses do: the focus is not beyond infinity, and where it is known, it stays.
BlurGuess allowed(BlurGuess guess, const Comparison &pictures, const KnownLens &known);

// The gathered picture as a plate of this softness shows it, with the tone curve of the plate.
Rgb as_plate(const Comparison &pictures, const Rgb &gathered, double softness);

// How uncertain a fit is: the variances of its CoC and its scale, and their covariance.
struct LensCovariance {
    double coc = 0, both = 0, scale = 0;
};

// An axis of the ellipse of one standard deviation: its direction, of unit length, in pixels of CoC at the middle depth
// and at the ends; and its variance.
struct LensAxis {
    double coc = 0, ends = 0, variance = 0;
};

// The longer one first. `half_range`: of the disparities.
std::array<LensAxis, 2> axes_of(const LensCovariance &covariance, double half_range);

struct LensFit {
    BlurGuess guess;
    double likelihood = 0;     // the sum over the blocks
    LensCovariance covariance; // from how much the blocks differ from each other
    Changes motion{};          // of the plate: the two last changes
    std::vector<BlockFit> blocks;
    Rgb shown; // the gathered picture, softened and tone-mapped
};

// The guesses that a search may begin with, the best first; no two are near each other.
std::vector<BlurGuess> search_lens(const Comparison &pictures, const KnownLens &known);

// Goes from a guess to the nearest maximum of the likelihood, which is expected `reach_px` pixels of CoC away. Compares
// at most `lenses` lenses. The fit has no covariance and no motion.
LensFit refine_lens(const Comparison &pictures, const KnownLens &known, const BlurGuess &guess, int lenses,
                    double reach_px);

// The sum over the blocks.
double likelihood_of(const std::vector<BlockFit> &blocks);

// Like refine_lens(), with the covariance and the motion.
LensFit measured_lens(const Comparison &pictures, const KnownLens &known, const BlurGuess &guess, int lenses,
                      double reach_px);

// Widens the covariance to what the likelihood of other lenses says, and goes to a better lens among them if there is
// one. The blocks' derivatives alone make it too narrow: they contain the noise of the gathered pictures, so the blocks
// seem to tell lenses apart that fit about as well. A lens that is d deviations away is worse by a lead of d / 2.
// Where the focus or the radius is known, the fit stays as it is: on a plate with few lamps, leads are always small.
LensFit widened(const Comparison &pictures, const KnownLens &known, LensFit fit);

// How much better `a` fits than `b`, in standard deviations of what the blocks say.
double lead(const LensFit &a, const LensFit &b);

} // namespace sparselens
