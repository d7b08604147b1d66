// Describes the effect to a host: contexts, pixels, clips and parameters.
#pragma once

#include "ofx.h"

namespace sparselens_ofx {

inline constexpr const char *source_clip = "Source", *depth_clip = "Depth", *output_clip = "Output";

void describe(OfxImageEffectHandle effect);
void describe_in_context(OfxImageEffectHandle effect, OfxPropertySetHandle arguments);

} // namespace sparselens_ofx
