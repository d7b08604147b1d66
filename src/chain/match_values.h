// The values of a matched lens, from what the search found, and the ranges that should hold the true ones; and why they
// may be wrong.
#pragma once

#include "chain/match_lens.h"
#include "chain/match_pictures.h"
#include "match/evidence.h"

#include <limits>
#include <optional>
#include <string>

namespace sparselens {

inline constexpr double certain = 1.645; // standard deviations to each side that hold 90 %
inline constexpr double infinite = std::numeric_limits<double>::infinity();

// The distance whose reciprocal this is; infinite if that is not above 0.
double distance_at(double inverse);

void set_values(MatchedLens &of, const Match &match, const Reduced &in, const LensFit &fit);

// The f-number times the radius of the lens, scene units, if the camera tells it.
std::optional<double> stops_by_radius(const Camera &camera);

// The ranges, from the values and their deviations; and the f-stop.
void set_intervals(MatchedLens &of, std::optional<double> stops_by_radius);

// Why the values that a search found are not those of the plate's lens, and what to do; empty: there is no doubt.
// `is_ambiguous`: another lens fits as well.
std::string doubt_of(const MatchedLens &lens, const Reduced &in, const LensFit &fit, const Evidence &evidence,
                     bool is_ambiguous);

} // namespace sparselens
