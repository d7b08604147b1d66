// --recolor: the flat picture that gives deep samples their colours.
#pragma once

#include "harness/tool.h"
#include "io/open_ldi.h"
#include "options/colour_options.h"

#include <string>

namespace sparselens {

// Opens the picture, makes its colours linear, recolours the LDI and warns; nothing where the path is empty. What io/recolor_ldi.h
// throws.
void recolor_by(const ToolContext &tool, const std::string &path, const PictureChoice &choice,
                const ColourOptions &colour, OpenedLdi &ldi);

} // namespace sparselens
