// The depth of a picture from a file of its own. Not for use outside io/.
#pragma once

#include "io/exr/exr_flat.h"

#include <string>

namespace sparselens {

// Reads the depth of choice.depth_file and puts it into the picture as Z, in place of any depth there. Notes and
// warnings name what it read. The depth is the channel found by its name (depth_channel.h); otherwise the only channel;
// otherwise the first of R, G and B. Outside its data window it is 0. Throws Error if the file has no depth, or differs
// from the picture in display window or pixel aspect ratio.
void put_depth_of_file(FlatFile &picture, const std::string &path, const PictureChoice &choice);

} // namespace sparselens
