// What a denoiser made of the views of a request.
#pragma once

#include "chain/make_ldi.h"

#include <vector>

namespace sparselens {

// Gives the denoised pictures of the request to the views, whose colours are linear (denoised/denoised_views.h): from files, which it
// opens and makes linear, from memory, or from the views themselves, which hold both. Nothing where there are none. Throws UsageError
// where there are not as many as views.
void take_denoised(const LdiFromViews &request, const WarpOptions &by, std::vector<PackedView> &views,
                   const Tell &tell);

} // namespace sparselens
