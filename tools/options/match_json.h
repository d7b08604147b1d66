// A matched lens as JSON, with infinity as "inf": for programs that run dof-match, and for the page of dof-view.
#pragma once

#include "chain/match_lens.h"

#include <nlohmann/json.hpp>

namespace sparselens {

nlohmann::ordered_json as_json(const MatchedLens &lens);
nlohmann::ordered_json as_json(const MatchedShape &shape);

// A number that JSON can hold, else "inf".
nlohmann::ordered_json finite_json(double value);

} // namespace sparselens
