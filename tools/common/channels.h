// The --channels option: which channels a tool carries.
#pragma once

#include "ldi/ldi.h"

#include <string>

namespace sparselens {

// `list`: comma-separated channel names ("R"), layers ("diffuse" for all diffuse.*) or "rgba"; empty: all.
// Leaves those in the LDI, and R, G, B and A: visibility needs the coverage, and a method that looks for highlights
// must find the same ones whatever is asked for. UsageError for a name the file does not have.
void keep_channels(Ldi &ldi, const std::string &list);

// The channels of `image` that the list names: drops those that were kept only for the method.
Image chosen_channels(Image image, const std::string &list);

} // namespace sparselens
