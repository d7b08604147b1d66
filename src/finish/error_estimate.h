// Estimates the error of a finished picture without a reference: on average, two independent renders are as good as the
// truth.
//
// Let F and G be the pictures made of the renders x and y. Then the mean of (F - y)(G - x) + (F - G)(x - y) is the
// product of their errors without noise: the first product misses the noise that each picture took from its own render,
// and the second product adds it. The noise that is left in the picture of both renders adds n m / (n + m)^2 (F - G)^2
// for n and m samples. No term squares the noise of one render, so single bright rays do not decide.
#pragma once

#include "finish/finish.h"

#include <optional>

namespace sparselens {

struct ErrorEstimate {
    Values map;      // mean squared error around each pixel, tone-mapped (tone_map.h), at least 0
    double mean = 0; // of the picture; negative if it is too small to be measured
    double standard_deviation = 0; // of the mean
    double of_one = 0;             // the mean for pictures made of only one of the renders
};

ErrorEstimate estimate_error(const FinishedLayer &finished, const Halves &rays,
                             const std::array<double, 2> &samples, const Grid &grid);

// 10 log10(1 / error); empty if the estimate differs from 0 by less than twice its standard deviation.
std::optional<double> decibels(const ErrorEstimate &error);

// By which factor the rays must grow for a finished picture of `goal` dB, judged by how much the error falls from one
// render to two; at least 1, empty if that cannot be determined.
std::optional<double> times_the_rays(const ErrorEstimate &error, const std::array<double, 2> &samples,
                                     double goal);

} // namespace sparselens
