// Passes denoised pictures of a request to its views.
#pragma once

#include "chain/make_ldi.h"

#include <vector>

namespace sparselens {

// Gives the denoised pictures of the request to the views, whose colours are linear (denoised/denoised_views.h). The
// pictures come from files, which it opens and makes linear, from memory, or from the views themselves, if these hold
// both. Does nothing if there are none. Throws UsageError if their number is not that of the views.
void take_denoised(const LdiFromViews &request, const WarpOptions &by, std::vector<PackedView> &views,
                   const Tell &tell);

} // namespace sparselens
