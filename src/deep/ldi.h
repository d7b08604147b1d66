// The layered depth image: in each pixel any number of samples, sorted by depth. One structure of arrays serves
// an LDI of ours, a deep file of anyone's and a flat picture with depth (one sample a pixel).
//
// Pixel i = row * width + column of the data window owns samples [begin[i], begin[i + 1]).
// Colours are premultiplied by coverage and scene-linear; what is not covered is transparent background at
// infinity.
#pragma once

#include "base/image.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

struct Ldi {
    Windows windows;
    std::vector<Channel> channels;    // what is carried: R, G, B, A and further layers; not Z or ldi.*
    std::vector<std::uint64_t> begin; // pixels + 1 entries, the first 0

    // One entry a sample, in pixel order.
    std::vector<float> z;      // planar depth of the front, scene units, (0, inf]
    std::vector<float> z_back; // >= z; empty where no sample has an extent (points)
    std::vector<float> dx, dy; // offset from the pixel centre, [-1/2, 1/2], y down; empty means 0
    std::vector<float> weight; // view samples merged into this one, > 0; empty means 1
    std::vector<std::vector<float>> values; // [channel][sample]

    std::size_t samples() const { return z.size(); }
    std::size_t alpha() const { return find_channel(channels, "A"); } // npos: all samples opaque
};

// Sorts every pixel by z (then z_back, then the order they stand in), drops samples that show nothing (neither
// coverage nor light), splits and merges overlapping volumes and merges points of one depth by the rules of
// "Interpreting OpenEXR Deep Pixels" (F. Kainz, 2013). Then z ascends strictly: a volume that begins at a point's
// depth begins one ulp behind it, and at infinity lies at most one sample. A volume that overlaps others and
// reaches to infinity has no density that could be split, and becomes a point at its front. What is tidy already is
// handed back as it came.
Ldi tidy(Ldi ldi);

// The tidy LDI composited front to back in file order: `over`, all channels of `ldi`, its data window, each by its
// own coverage (coloured_alpha.h).
Image flatten(const Ldi &ldi);

} // namespace sparselens
