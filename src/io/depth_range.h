// The planes that the depths of a file refer to: `near` and `far` of the user, otherwise those of its header.
#pragma once

#include "../view/depth.h"
#include "open_options.h"

#include <ImfHeader.h>

#include <optional>
#include <span>
#include <string>

namespace sparselens {

// Only normalised and hyperbolic depths need a near plane and take planes from the header (the attributes near and far,
// nearClip and farClip, clipNear and clipFar). Throws UsageError if a needed plane is unknown, the far one is not
// behind the near one, or a near plane is given for other depths.
DepthRange depth_range(const DepthOptions &options, const Imf::Header &header);

// A warning if depths that are read unchanged look like normalised ones: none is above 1, and the farthest are exactly
// 1. For a flat picture of that grid it also warns if they bend like depths that are white near (picture_checks.h).
std::optional<std::string> normalized_warning(const DepthOptions &options, std::span<const float> depths);
std::optional<std::string> normalized_warning(const DepthOptions &options, std::span<const float> depths,
                                              const Grid &grid);

} // namespace sparselens
