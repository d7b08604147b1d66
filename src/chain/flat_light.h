// The light of a flat picture that goes with others: a beauty for deep samples, what a denoiser made of a view.
#pragma once

#include "chain/colours.h"
#include "chain/notices.h"
#include "io/exr/exr_flat.h"

#include <string>

namespace sparselens {

struct FlatLight {
    std::string name; // of the file, for messages
    Image image;      // light and coverage alone: valid values
    Imf::Header header;
};

// Takes the light of a file that is read; its colours are made linear as `colour` says, or are where there is none. `path` is for messages.
FlatLight light_of(FlatFile file, const std::string &path, const ColourOptions *colour, const Tell &tell);

// The choice of a picture that need not have depth.
PictureChoice without_depth(PictureChoice choice);

// Reads a flat EXR; the choice is that of the picture it goes with, but for its depth. Throws Error, naming the file, where it is deep or
// cannot be read.
FlatLight open_light(const std::string &path, const PictureChoice &choice, const ColourOptions *colour,
                     const Tell &tell);

} // namespace sparselens
