// The light of a flat picture that belongs to another one: a beauty for deep samples, or a denoised view.
#pragma once

#include "chain/colours.h"
#include "chain/notices.h"
#include "io/exr/exr_flat.h"

#include <string>

namespace sparselens {

struct FlatLight {
    std::string name; // of the file, for messages
    Image image;      // light and coverage only: valid values
    Imf::Header header;
};

// Takes the light of a file that was read. `colour` says how its colours are made linear; null: they are linear. `path`
// is for messages.
FlatLight light_of(FlatFile file, const std::string &path, const ColourOptions *colour, const Tell &tell);

// The choice for a picture that need not have depth.
PictureChoice without_depth(PictureChoice choice);

// Reads a flat EXR. `choice` is that of the picture to which it belongs, except for its depth. Throws Error, naming the
// file, if it is deep or cannot be read.
FlatLight open_light(const std::string &path, const PictureChoice &choice, const ColourOptions *colour,
                     const Tell &tell);

} // namespace sparselens
