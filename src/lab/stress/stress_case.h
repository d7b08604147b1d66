// Stiff and extreme cases, each with what it should give and how far it may be off: the table behind dof-stress.
#pragma once

#include <cmath>
#include <limits>
#include <span>

namespace sparselens::lab {

// What one case measured.
struct StressResult {
    double error = 0; // as the case's claim says; at most its bound
    double energy =
        std::numeric_limits<double>::quiet_NaN(); // relative change of the sum of light; NaN: has no meaning
    double seconds = 0, pixels = 0;               // of the kernel alone
};

struct StressCase {
    const char *name;
    const char *claim; // what is compared with what
    double bound;
    const char *reason;    // for the bound
    StressResult (*run)(); // what it throws is a failure
};

struct StressFamily {
    const char *name;
    std::span<const StressCase> cases;
};

std::span<const StressCase> depth_stress();
std::span<const StressCase> blur_stress();
std::span<const StressCase> light_stress();
std::span<const StressCase> shape_stress();
std::span<const StressCase> view_stress();
std::span<const StressCase> scale_stress();

std::span<const StressFamily> stress_families();

// Light may neither be lost nor made: docs/tolerances.md, section 3.
inline constexpr double energy_bound = 1e-4;

inline bool energy_is_kept(const StressResult &r) { return !(std::abs(r.energy) > energy_bound); }
inline bool holds(const StressCase &c, const StressResult &r) {
    return r.error <= c.bound && energy_is_kept(r);
}

// Time against the plain case: a textured plane at a CoC of 4 pixels. Of a larger picture the time a pixel, of a
// smaller one the whole.
double times_plain(const StressResult &result);

} // namespace sparselens::lab
