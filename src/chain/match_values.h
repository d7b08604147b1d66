// The values of a matched lens, from what the search found, and the ranges that hold the true ones.
#pragma once

#include "chain/match_lens.h"
#include "chain/match_pictures.h"

#include <optional>

namespace sparselens {

inline constexpr double certain = 1.645; // standard deviations to each side that hold 90 %

void set_values(MatchedLens &of, const Match &match, const Reduced &in, const LensFit &fit);

// The f-number times the radius of the lens, scene units, if the camera tells it.
std::optional<double> stops_by_radius(const Camera &camera);

// The ranges, from the values and their deviations; and the f-stop.
void set_intervals(MatchedLens &of, std::optional<double> stops_by_radius);

} // namespace sparselens
