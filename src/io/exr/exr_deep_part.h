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

// The file that is read; its size limits the memory that it may ask for.
struct DeepSource {
    Imf::MultiPartInputFile &file;
    const InputStream &stream; // of the file
    const std::string &path;
    std::uint64_t size;
    double held = 0; // bytes of memory that the parts read so far take
};

// Makes an LDI of the same windows of that of some rows: of fewer samples; or none. Called by several threads at once.
using ReduceRows = std::function<std::optional<Ldi>(Ldi rows)>;

// Reads `channels` of the part: `depth` and depthBack, those that position samples, and the others as values. If
// `depth` is empty there is no depth, and z stays empty. Samples are returned as they stand in the file. Throws Error,
// naming the file, where it is damaged or asks for more memory than it may. With `reduce`, which needs a part of scanlines, a
// few rows are read at a time, and what it makes of them is kept: in `packed` where it is much, which leaves the LDI
// without samples. So it is left where it makes none of some rows; others are not read then.
Ldi read_deep_part(const DeepSource &source, int number, const std::vector<FileChannel> &channels,
                   const std::string &depth);
Ldi read_deep_part(const DeepSource &source, int number, const std::vector<FileChannel> &channels,
                   const std::string &depth, const ReduceRows &reduce, std::optional<PackedRows> &packed);

// A flat picture as an LDI of one sample per pixel.
Ldi ldi_of_flat(const Image &image, const std::string &depth);

} // namespace sparselens
