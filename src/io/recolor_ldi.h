// The flat picture that gives an LDI its colours (deep/recolor.h), from a file.
#pragma once

#include "exr/exr_flat.h"
#include "open_ldi.h"

#include <string>
#include <vector>

namespace sparselens {

struct Beauty {
    std::string name; // of the file, for messages
    Image image;      // valid values
    Imf::Header header;
    InvalidValues bad; // what was repaired
    std::vector<std::string> notes = {}, warnings = {};
};

// Opens a flat EXR; the choice is that of the deep picture, without its depth.
// Throws Error, naming the file, where it is deep, cannot be read or has no light.
Beauty open_beauty(const std::string &path, const PictureChoice &choice);
Beauty ready_beauty(FlatFile file, const std::string &path);

// Recolours the LDI, whose header then says the colour space and the names of the colours of the beauty. Returns what is to be warned
// of. Throws Error, naming both files, where their display windows or pixels differ in shape, or they have no pixel in common.
std::vector<std::string> recolor(OpenedLdi &ldi, const Beauty &beauty);

} // namespace sparselens
