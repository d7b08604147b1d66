// The --channels option: which channels a tool carries.
#pragma once

#include "deep/ldi.h"

#include <string>

namespace sparselens {

// `list`: comma-separated channel names ("R"), layers ("diffuse" for all diffuse.*) or "rgba"; empty: all.
// Leaves those in the LDI, and R, G, B, A, and what covers any of them: by coverage and brightness it is decided how
// all is gathered. UsageError for a name the file does not have.
void keep_channels(Ldi &ldi, const std::string &list);

// The channels of `image` that the list names: drops what only the gather needed.
Image chosen_channels(Image image, const std::string &list);

} // namespace sparselens
