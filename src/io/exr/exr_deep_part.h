// The samples of one deep part, scanline or tiled. Not for use outside io/.
#pragma once

#include "deep/ldi.h"
#include "io/exr/exr_parts.h"

#include <ImfMultiPartInputFile.h>

#include <cstdint>
#include <string>
#include <vector>

namespace sparselens {

// The file that is read; its size is what it may ask memory for.
struct DeepSource {
    Imf::MultiPartInputFile &file;
    const std::string &path;
    std::uint64_t size;
    double held = 0; // bytes that what has been read of it takes
};

// These of the part's channels: `depth` and depthBack, those that place samples, the others as values. `depth` empty:
// there is none, and z stays empty. Samples come as they stand in the file. Error, naming the file: damage, or more
// memory than it may ask for.
Ldi read_deep_part(const DeepSource &source, int number, const std::vector<FileChannel> &channels,
                   const std::string &depth);

// A flat picture, one sample a pixel.
Ldi ldi_of_flat(const Image &image, const std::string &depth);

} // namespace sparselens
