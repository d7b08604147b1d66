// The actions of an instance of the effect. They return the status of the action, or throw.
#pragma once

#include "ofx.h"

namespace sparselens_ofx {

OfxStatus render(OfxImageEffectHandle effect, OfxPropertySetHandle arguments);

// The pixels that the LDI gives; the host's own choice for a flat picture.
OfxStatus region_of_definition(OfxImageEffectHandle effect, OfxPropertySetHandle arguments,
                               OfxPropertySetHandle result);

// All of the source and its depth, because blur reaches far.
OfxStatus regions_of_interest(OfxImageEffectHandle effect, OfxPropertySetHandle arguments,
                              OfxPropertySetHandle result);

// A sequence varies by frame, whether or not parameters have keys.
OfxStatus clip_preferences(OfxImageEffectHandle effect, OfxPropertySetHandle result);

} // namespace sparselens_ofx
