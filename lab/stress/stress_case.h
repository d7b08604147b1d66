// Extreme and numerically stiff cases, each with its expected result and a bound on the error: the table behind
// dof-stress.
#pragma once

#include <cmath>
#include <limits>
#include <span>

namespace sparselens::lab {

// The measurements of one case.
struct StressResult {
    double error = 0; // as the claim of the case defines it; must not exceed its bound
    // The relative change of the sum of light; NaN if it has no meaning.
    double energy = std::numeric_limits<double>::quiet_NaN();
    double seconds = 0, pixels = 0; // for the kernel alone
};

struct StressCase {
    const char *name;
    const char *claim; // what is compared with what
    double bound;
    const char *reason;    // the reason for the bound
    StressResult (*run)(); // an exception is a failure
};

struct StressFamily {
    const char *name;
    std::span<const StressCase> cases;
};

std::span<const StressCase> depth_stress();
std::span<const StressCase> blur_stress();
std::span<const StressCase> light_stress();
std::span<const StressCase> lamp_stress();
std::span<const StressCase> steep_stress();
std::span<const StressCase> shape_stress();
std::span<const StressCase> look_stress();
std::span<const StressCase> view_stress();
std::span<const StressCase> scale_stress();
std::span<const StressCase> cost_stress();

std::span<const StressFamily> stress_families();

// Light may not be lost or created: docs/tolerances.md, section 3.
inline constexpr double energy_bound = 1e-4;

inline bool energy_is_kept(const StressResult &r) { return !(std::abs(r.energy) > energy_bound); }
inline bool holds(const StressCase &c, const StressResult &r) {
    return r.error <= c.bound && energy_is_kept(r);
}

// The time relative to the plain case, a textured plane at a CoC of 4 pixels: per pixel for a larger picture, in total
// for a smaller one.
double times_plain(const StressResult &result);

} // namespace sparselens::lab
