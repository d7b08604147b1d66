// Tells from the centre views of a shutter's moments how many moments it needs (plan/moments_needed.h).
#pragma once

#include "chain/plan_views.h"
#include "plan/moments_needed.h"

#include <cstddef>
#include <optional>

namespace sparselens {

// `first` and `last` are the first and the last of so many moments, at least 2, with the lens of the plan. The camera's
// motion follows from their matrices, if they have them; else all motion is found in the pictures. Empty if the
// pictures do not tell. Throws Error, naming both files, if their sizes differ.
std::optional<MomentsNeed> plan_moments(const OpenedView &first, const OpenedView &last, std::size_t moments,
                                        const PlannedViews &planned, const LensValues &lens);

} // namespace sparselens
