// --denoised and --noisy: what a denoiser made of the views.
#pragma once

#include "deep/packed_view.h"
#include "harness/tool.h"
#include "options/warp_options.h"

#include <vector>

namespace sparselens {

// Opens the denoised pictures and makes their colours linear, or parts them from the views, whose colours are linear, and gives
// them to the views (denoised/denoised_views.h); nothing where none is named. Throws UsageError where there are not as many as
// views.
void take_denoised(const ToolContext &tool, const WarpCommand &options, std::vector<PackedView> &views,
                   const WarpOptions &by);

} // namespace sparselens
