// The colours of files: linear while the chain works on them, in another space or for a display when they are written.
#pragma once

#include "../deep/ldi.h"
#include "../io/display/colour.h"
#include "../io/display/shown_picture.h"
#include "../io/exr/compression.h"
#include "../io/exr/exr_flat.h"
#include "../io/open_ldi.h"
#include "notices.h"

#include <ImfHeader.h>

#include <optional>
#include <string>
#include <vector>

namespace sparselens {

struct PackedView; // deep/view_samples.h

struct ColourOptions {
    std::string config = {}, input_space = {}; // `colorconfig`, `colorspace`
    std::string output_space = {}, display = {},
                view = {}; // `output_colorspace`; `display`, `view_transform`
};

// Makes the colours of a file linear, and returns its header, which then states their space (colour.h). Their
// space in the file is `colorspace`; if this is empty, the space that the header states; otherwise files of these tools
// are scene-linear, and the file rules of the configuration name the space of other files. Colours in a linear space
// with known chromaticities stay as they are; all others become scene-linear.
Imf::Header to_linear(const Notify &notify, const ColourOptions &options, const std::string &path,
                      const Imf::Header &header, Ldi &ldi);
Imf::Header to_linear(const Notify &notify, const ColourOptions &options, const std::string &path,
                      const Imf::Header &header, PackedView &view);
Imf::Header to_linear(const Notify &notify, const ColourOptions &options, const std::string &path,
                      const Imf::Header &header, Image &image);

struct NamedHeader {
    const Imf::Header &header;
    std::string name; // of the file, for messages
};

// Converts linear colours from the space that their header states (`stated`) to the space that `wanted` states, with a
// notice, if the two differ.
void to_space_of(const Notify &notify, const ColourOptions &options, const NamedHeader &wanted,
                 const NamedHeader &stated, Image &image);

// Whether two headers state the same chromaticities, as far as headers round them, or neither states any.
bool same_chromaticities(const Imf::Header &a, const Imf::Header &b);

// Whether to_linear() leaves the colours of such a file unchanged.
bool is_linear(const Notify &notify, const ColourOptions &options, const std::string &path,
               const Imf::Header &header);

// The transform from linear colours, in the space that `metadata` states, to those of a PNG; see write_picture().
ColourTransform output_transform(const ColourOptions &options, const Imf::Header &metadata);

// Converts the linear colours and the header of a picture to those of an OpenEXR file in `output_colorspace`; see
// write_picture(). Throws UsageError, naming `path`, if a display is given.
void to_exr_space(const ColourOptions &options, const std::string &path, Image &image, Imf::Header &header);

// Converts the linear colours of a picture to those of the file `path` (PNG, JPEG, .hdr and the like); see
// write_picture(). Returns what the file holds beside them; nothing if the colours stay linear.
std::optional<ShownExtras> to_shown_colours(const ColourOptions &options, const std::string &path,
                                            Image &image, const Imf::Header &metadata);

// Writes a picture of linear colours, in the space of the chromaticities of `metadata`, or else scene-linear. OpenEXR
// files are written in `output_colorspace` (default: the picture's own), stated by chromaticities; so are files of
// linear light such as .hdr. PNG, JPEG, TIFF and the like are written in `output_colorspace`, or else through `display`
// and `view_transform` (default: those of the configuration); those of a photograph without either in its own encoding,
// with what its file holds beside its colours (io/photograph.h). `compression` is that of OpenEXR (compression.h). Throws
// UsageError for a display with an OpenEXR file, and for a compression or tiles with any other.
void write_picture(const Notify &notify, const ColourOptions &options, const std::string &path, Image image,
                   const Imf::Header &metadata, std::optional<Imf::Compression> compression = {},
                   int tiles = 0);

// The light of a flat picture that belongs to another one: a beauty for deep samples, or a denoised view.
struct LdiFromViews; // chain/make_ldi.h
struct WarpOptions;  // warp/warp.h

// Gives the denoised pictures of the request to the views, whose colours are linear (denoised/denoised_views.h). The
// pictures come from files, which it opens and makes linear, from memory, or from the views themselves, if these hold
// both. Does nothing if there are none. Throws UsageError if their number is not that of the views.
void take_denoised(const LdiFromViews &request, const WarpOptions &by, std::vector<PackedView> &views,
                   const Notify &notify);

// Gives an LDI the colours of the picture (deep/recolor.h). Its header then states the colour space and the names of
// the file's colours. `colour` says how these are made linear; null: they are linear. `path` is for messages. Throws
// Error, naming both files, if their display windows or the shapes of their pixels differ, or they have no pixel in
// common; and if the file has no colours.
void recolor_by(FlatFile file, const std::string &path, const ColourOptions *colour, OpenedLdi &ldi,
                const Notify &notify);

// The same with a flat EXR. `choice` is that of the picture with the samples, except for its depth. Does nothing if the
// path is empty. Throws Error, naming the file, if it is deep or cannot be read.
void recolor_by(const std::string &path, const PictureChoice &choice, const ColourOptions &colour,
                OpenedLdi &ldi, const Notify &notify);

} // namespace sparselens
