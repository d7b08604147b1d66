// The colours of files: linear while the chain works on them, in another space or for a display when they are written.
#pragma once

#include "../deep/ldi.h"
#include "../io/display/colour.h"
#include "../io/exr/compression.h"
#include "notices.h"

#include <ImfHeader.h>

#include <optional>
#include <string>

namespace sparselens {

struct PackedView; // deep/packed_view.h

struct ColourOptions {
    std::string config = {}, input_space = {}; // `colorconfig`, `colorspace`
    std::string output_space = {}, display = {},
                view = {}; // `output_colorspace`; `display`, `view_transform`
};

// Makes the colours of a file linear, and returns its header, which then states their space (stated_space.h). Their
// space in the file is `colorspace`; if this is empty, the space that the header states; otherwise files of these tools
// are scene-linear, and the file rules of the configuration name the space of other files. Colours in a linear space
// with known chromaticities stay as they are; all others become scene-linear.
Imf::Header to_linear(const Tell &tell, const ColourOptions &options, const std::string &path,
                      const Imf::Header &header, Ldi &ldi);
Imf::Header to_linear(const Tell &tell, const ColourOptions &options, const std::string &path,
                      const Imf::Header &header, PackedView &view);
Imf::Header to_linear(const Tell &tell, const ColourOptions &options, const std::string &path,
                      const Imf::Header &header, Image &image);

// Whether to_linear() leaves the colours of such a file unchanged.
bool is_linear(const Tell &tell, const ColourOptions &options, const std::string &path,
               const Imf::Header &header);

// The transform from linear colours, in the space that `metadata` states, to those of a PNG; see write_picture().
ColourTransform output_transform(const ColourOptions &options, const Imf::Header &metadata);

// Makes the linear colours of a picture those of an OpenEXR file in `output_colorspace`, and its header that of the
// file; see write_picture(). Throws UsageError, naming `path`, if a display is given.
void to_exr_space(const ColourOptions &options, const std::string &path, Image &image, Imf::Header &header);

// Writes a picture of linear colours, in the space of the chromaticities of `metadata`, or else scene-linear. OpenEXR
// files are written in `output_colorspace` (default: the picture's own space), stated by chromaticities. PNG, JPEG,
// TIFF and the like are written in `output_colorspace`, or else through `display` and `view_transform` (default: those
// of the configuration). `compression` is that of OpenEXR (compression.h). Throws UsageError for a display with an
// OpenEXR file, and for a compression or tiles with any other. Returns what write_flat_exr returns.
std::size_t write_picture(const Tell &tell, const ColourOptions &options, const std::string &path,
                          Image image, const Imf::Header &metadata,
                          std::optional<Imf::Compression> compression = {}, int tiles = 0);

} // namespace sparselens
