// The flat picture that gives an LDI its colours (deep/recolor.h).
#pragma once

#include "chain/colours.h"
#include "chain/notices.h"
#include "io/exr/exr_flat.h"
#include "io/open_ldi.h"

#include <string>

namespace sparselens {

// Recolours the LDI, whose header then says the colour space and the names of the colours of the file; these are made linear as
// `colour` says, or are where there is none. `path` is for messages. Throws Error, naming both files, where their display windows or
// pixels differ in shape, or they have no pixel in common, and where the file has no colours.
void recolor_by(FlatFile file, const std::string &path, const ColourOptions *colour, OpenedLdi &ldi,
                const Tell &tell);

// The same by a flat EXR; the choice is that of the picture with the samples, but for its depth.
// Nothing where the path is empty. Throws Error, naming the file, where it is deep or cannot be read.
void recolor_by(const std::string &path, const PictureChoice &choice, const ColourOptions &colour,
                OpenedLdi &ldi, const Tell &tell);

} // namespace sparselens
