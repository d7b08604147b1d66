// The light of a flat picture that belongs to another one: a beauty for deep samples, or a denoised view.
#pragma once

#include "chain/colours.h"
#include "chain/notices.h"
#include "io/exr/exr_flat.h"
#include "io/open_ldi.h"

#include <string>
#include <vector>

namespace sparselens {

struct LdiFromViews; // chain/make_ldi.h
struct PackedView;   // deep/packed_view.h
struct WarpOptions;  // warp/warp.h

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

// Gives the denoised pictures of the request to the views, whose colours are linear (denoised/denoised_views.h). The
// pictures come from files, which it opens and makes linear, from memory, or from the views themselves, if these hold
// both. Does nothing if there are none. Throws UsageError if their number is not that of the views.
void take_denoised(const LdiFromViews &request, const WarpOptions &by, std::vector<PackedView> &views,
                   const Tell &tell);

// Gives an LDI the colours of the picture (deep/recolor.h). Its header then states the colour space and the names of
// the file's colours. `colour` says how these are made linear; null: they are linear. `path` is for messages. Throws
// Error, naming both files, if their display windows or the shapes of their pixels differ, or they have no pixel in
// common; and if the file has no colours.
void recolor_by(FlatFile file, const std::string &path, const ColourOptions *colour, OpenedLdi &ldi,
                const Tell &tell);

// The same with a flat EXR. `choice` is that of the picture with the samples, except for its depth. Does nothing if the
// path is empty. Throws Error, naming the file, if it is deep or cannot be read.
void recolor_by(const std::string &path, const PictureChoice &choice, const ColourOptions &colour,
                OpenedLdi &ldi, const Tell &tell);

} // namespace sparselens
