// The samples of one deep part, scanline or tiled. Not for use outside io/.
#pragma once

#include "deep/ldi.h"
#include "deep/packed_rows.h"
#include "io/exr/exr_parts.h"
#include "io/files/file_stream.h"

#include <ImfMultiPartInputFile.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace sparselens {

// The file to read; its size limits the memory that it may ask for.
struct DeepSource {
    Imf::MultiPartInputFile &file;
    const InputStream &stream; // of the file
    const std::string &path;
    std::uint64_t size;
    double held = 0; // bytes of memory taken by the parts read so far
};

// Makes an LDI with fewer samples and the same windows from that of some rows; or returns nothing. Several threads call
// it.
using ReduceRows = std::function<std::optional<Ldi>(Ldi rows)>;

// Reads `channels` of the part: `depth` and depthBack, those that position samples, and the others as values. If
// `depth` is empty there is no depth, and z stays empty. Samples are returned as they stand in the file. Throws Error,
// naming the file, if it is damaged or asks for more memory than it may. `reduce` needs a part of scanlines: a few rows
// are read at a time, and its results are kept, in `packed` if they are large, and then the LDI has no samples. If
// `reduce` returns nothing for some rows, the LDI has no samples either, and the remaining rows are not read.
Ldi read_deep_part(const DeepSource &source, int number, const std::vector<FileChannel> &channels,
                   const std::string &depth, const ReduceRows &reduce, std::optional<PackedRows> &packed);

// A flat picture as an LDI of one sample per pixel.
Ldi ldi_of_flat(const Image &image, const std::string &depth);

} // namespace sparselens
