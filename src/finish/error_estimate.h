// The error of a finished picture, known without a reference: two independent renders are as good as the truth in the mean.
//
// Let F and G be what was made of the renders x and y. Then (F - y)(G - x) + (F - G)(x - y) is in the mean the product of their
// errors without noise: the first product lacks what each picture took of its own render's noise, which the second adds. The
// noise that is left in the picture of both adds n m / (n + m)^2 (F - G)^2 for n and m samples. No term squares a single
// render's noise, so single bright rays do not decide.
#pragma once

#include "finish/finish.h"

#include <optional>

namespace sparselens {

struct ErrorEstimate {
    Values map;      // mean squared error around each pixel, tone-mapped (tone_map.h), at least 0
    double mean = 0; // of the picture; below 0 where it is too small to be told
    double standard_deviation = 0; // of the mean
    double of_one = 0;             // the mean for pictures made of one of the renders alone
};

ErrorEstimate estimate_error(const FinishedLayer &finished, const Halves &rays,
                             const std::array<double, 2> &samples, const Grid &grid);

// 10 log10(1 / error); empty where the estimate does not differ from 0 by twice its standard deviation.
std::optional<double> decibels(const ErrorEstimate &error);

// How many times the rays a finished picture of `goal` dB takes, as the error fell from one render to two of them; at least 1,
// empty where that cannot be told.
std::optional<double> times_the_rays(const ErrorEstimate &error, const std::array<double, 2> &samples,
                                     double goal);

} // namespace sparselens
