// The --channels option: which channels a tool carries.
#pragma once

#include "ldi/ldi.h"

#include <string>

namespace sparselens {

// `list`: comma-separated channel names ("R"), layers ("diffuse" for all diffuse.*) or "rgba"; empty: all.
// Leaves those and A, which visibility needs, in the LDI. UsageError for a name the file does not have.
void keep_channels(Ldi &ldi, const std::string &list);

// The channels of `image` that the list names: drops an A that only visibility needed.
Image chosen_channels(Image image, const std::string &list);

} // namespace sparselens
