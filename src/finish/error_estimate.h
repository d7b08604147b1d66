// Estimates the error of a finished picture without a reference: on average, two independent renders are as good as the
// truth.
//
// Let F and G be the pictures made of the renders x and y. Then the mean of (F - y)(G - x) + (F - G)(x - y) is the
// product of their errors without noise: the first product misses the noise that each picture took from its own render,
// and the second product adds it. The noise that is left in the picture of both renders adds n m / (n + m)^2 (F - G)^2
// for n and m samples. No term squares the noise of one render, so fireflies do not dominate.
#pragma once

#include "finish/finish.h"

#include <array>
#include <optional>

namespace sparselens {

struct ErrorEstimate {
    Values map;                    // mean squared error around each pixel, tone-mapped (light.h), at least 0
    double mean = 0;               // of the picture; by chance negative if these renders cannot tell it
    double standard_deviation = 0; // of the mean
    double of_one = 0;             // the mean for pictures made of only one of the renders
};

ErrorEstimate estimate_error(const FinishedLayer &finished, const Halves &rays, const RayCounts &samples,
                             const ArrayGrid &grid);

// 10 log10(1 / error); empty if the estimate differs from 0 by less than twice its standard deviation.
std::optional<double> decibels(const ErrorEstimate &error);

// The error falls as a power of the number of rays. This is minus the exponent, judged by how much the error falls from
// one render to two: 1/4 to 1.
double fall_of(const ErrorEstimate &error, const std::array<double, 2> &samples);

// By which factor the rays must grow for a finished picture of `goal` dB; at least 1, empty if decibels() is empty.
std::optional<double> times_the_rays(const ErrorEstimate &error, const std::array<double, 2> &samples,
                                     double goal);

} // namespace sparselens
