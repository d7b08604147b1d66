// The flat picture that gives an LDI its colours (deep/recolor.h).
#pragma once

#include "chain/colours.h"
#include "chain/notices.h"
#include "io/exr/exr_flat.h"
#include "io/open_ldi.h"

#include <string>

namespace sparselens {

// Recolours the LDI; its header then states the colour space and the names of the file's colours. `colour` says how
// these are made linear; null: they are linear. `path` is for messages. Throws Error, naming both files, if their
// display windows or the shapes of their pixels differ, or they have no pixel in common; and if the file has no
// colours.
void recolor_by(FlatFile file, const std::string &path, const ColourOptions *colour, OpenedLdi &ldi,
                const Tell &tell);

// The same with a flat EXR. `choice` is that of the picture with the samples, except for its depth. Does nothing if the
// path is empty. Throws Error, naming the file, if it is deep or cannot be read.
void recolor_by(const std::string &path, const PictureChoice &choice, const ColourOptions &colour,
                OpenedLdi &ldi, const Tell &tell);

} // namespace sparselens
