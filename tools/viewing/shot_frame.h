// One LDI that is looked at, and what a page is told of it whatever its lens.
#pragma once

#include "deep/packed_rows.h"
#include "io/display/colour.h"
#include "io/open_ldi.h"
#include "options/gather_options.h"

#include <cstdint>
#include <map>
#include <string>

namespace sparselens {

// The names of objects by their ids, as the manifests of Cryptomattes in the header have them.
using ObjectNames = std::map<std::uint32_t, std::string>;
ObjectNames object_names(const Imf::Header &header);

// The depths that the picture has, in (0, inf]; 1 and 1 where it has no samples. What images show counts too.
struct DepthExtent {
    double nearest = 1, farthest = 1;
};
DepthExtent depth_extent(const Ldi &ldi);

Ldi all_rows(const PackedRows &rows);

// The LDI is held in half the memory.
struct ShotFrame {
    OpenedLdi in;      // without its samples,
    PackedRows packed; // which are here
    int across = 1;    // sub-pixels of the LDI that become one pixel
    DepthExtent depths = {};
    ObjectNames names = {};
    ColourTransform to_display = {}; // of its colours, as PNG shows them

    Ldi row(int y) const; // of the data window
    OpenedLdi unpacked() const;

    // The camera and the lens of its picture. Throws as dof-gather does.
    Camera camera(const PictureRequest &request) const;
    ThinLens lens(const PictureRequest &request) const; // for pixels of the picture
};

ShotFrame pack(OpenedLdi in); // nothing else is known of it

// Throws Error where it has no R, G and B, which are what is shown.
ShotFrame shot_frame(OpenedLdi in, const WindowOptions &windows, const ColourOptions &colour);

} // namespace sparselens
