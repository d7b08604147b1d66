// The parameters of the effect at a time, as settings of dof-gather.
#pragma once

#include "ofx.h"

#include <map>
#include <string>

namespace sparselens_ofx {

// Only parameters that say something: not those that leave the choice to the file or the method.
std::map<std::string, std::string> settings_at(OfxImageEffectHandle effect, double time);

std::string text_at(OfxImageEffectHandle effect, const char *parameter, double time); // "" if there is none
int whole_at(OfxImageEffectHandle effect, const char *parameter, double time);        // the same with 0

} // namespace sparselens_ofx
