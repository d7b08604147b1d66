// One LDI on display, and the facts about it that do not depend on the lens.
#pragma once

#include "deep/packed_rows.h"
#include "io/display/colour.h"
#include "io/open_ldi.h"
#include "options/gather_options.h"
#include "viewing/view_words.h"

#include <cstdint>
#include <map>
#include <string>

namespace sparselens {

// Object id -> name, from the manifests of Cryptomattes in the header.
using ObjectNames = std::map<std::uint32_t, std::string>;
ObjectNames object_names(const Imf::Header &header);

// The range of depths in the picture, in (0, inf]; 1 and 1 if it has no samples. Depths of images count too.
struct DepthExtent {
    double nearest = 1, farthest = 1;
};
DepthExtent depth_extent(const Ldi &ldi);

Ldi all_rows(const PackedRows &rows);

// An LDI in half the memory.
struct ShotFrame {
    OpenedLdi in;      // the file without its samples
    PackedRows packed; // the samples
    int across = 1;    // sub-pixels of the LDI that become one pixel
    DepthExtent depths = {};
    ObjectNames names = {};
    ColourTransform to_display = {}; // from the file's colours to those of a PNG

    Ldi row(int y) const; // of the data window
    OpenedLdi unpacked() const;

    // The camera and the lens of the picture. Throws as dof-gather does.
    Camera camera(const PictureRequest &request) const;
    ThinLens lens(const PictureRequest &request) const; // for pixels of the picture
};

ShotFrame pack(OpenedLdi in); // sets only `in` and `packed`

// Throws Error if the file has no R, G and B, which the page shows.
ShotFrame shot_frame(OpenedLdi in, const WindowOptions &windows, const ColourOptions &colour);

// An initial lens if neither the file nor the command line gives one; the page is there to choose another. Options of
// dof-gather for what is unknown: 50 mm before a sensor 36 mm wide, f/2.8, focused on the middle of the picture. Empty
// if all is known.
Words lens_guess(const ShotFrame &frame, const Camera &camera);

// The same in words for people; empty for no options.
std::string guess_in_words(const Words &guess);

} // namespace sparselens
