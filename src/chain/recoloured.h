// The flat picture that gives deep samples their colours.
#pragma once

#include "chain/colours.h"
#include "io/recolor_ldi.h"

#include <string>

namespace sparselens {

// Recolours the LDI, and says what is to be said. What io/recolor_ldi.h throws.
void recolor_by(const Beauty &beauty, OpenedLdi &ldi, const Tell &tell);

// Opens the picture, makes its colours linear, and does the same; nothing where the path is empty.
void recolor_by(const std::string &path, const PictureChoice &choice, const ColourOptions &colour,
                OpenedLdi &ldi, const Tell &tell);

} // namespace sparselens
