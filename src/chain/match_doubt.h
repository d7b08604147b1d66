// Why the values that a search found are not those of the plate's lens.
#pragma once

#include "chain/match_lens.h"
#include "chain/match_pictures.h"
#include "match/evidence.h"

#include <string>

namespace sparselens {

// The reason, and what to do; empty: there is none. `is_ambiguous`: another lens fits as well.
std::string doubt_of(const MatchedLens &lens, const Reduced &in, const LensFit &fit, const Evidence &evidence,
                     bool is_ambiguous);

} // namespace sparselens
