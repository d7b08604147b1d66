// The quadratic function of two numbers that fits values at some places, as searches without derivatives use it
// (Powell 2002, Conn, Scheinberg and Vicente 2009).
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace sparselens {

struct Place {
    double x = 0, y = 0;
};

double distance(const Place &a, const Place &b);

// 1, x, y, x^2 / 2, x y, y^2 / 2
inline constexpr std::size_t quadratic_terms = 6;

class Quadratic {
public:
    // Around `middle`; x and y count in units of `reach`, > 0. Where places do not tell a term, it is small.
    Quadratic(std::span<const Place> places, const Place &middle, double reach);

    // The share that each place's value has in a term: the term is the sum of shares times values.
    std::span<const double> shares(std::size_t term) const { return shares_[term]; }

    // The place of the largest value, at most `reach` away from the middle.
    Place best(std::span<const double> values) const;

private:
    Place middle_;
    double reach_;
    std::array<std::vector<double>, quadratic_terms> shares_;
};

} // namespace sparselens
