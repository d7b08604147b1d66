// Fillers: what is taken to lie where no view could look.
//
// The ground of a pixel is the last thing that it holds: what lies at infinity where it is transparent (nothing), else
// its last sample of half coverage or more. A ground goes on along its row and its column behind nearer grounds, as far as
// some point of the lens could see of it: n pixels beyond its end while those are nearer by more than (n - 1) / sqrt(2)
// pixels of perceptive depth, as its edge may run at 45 degrees, and by more than one_surface_px. Where no ground is known,
// none goes on: what lies beyond the frame, beyond_frame.h says.
// Where grounds go on from several sides, the nearest side fills, of sides as near the farthest ground: the mean of
// those that are one surface with it, each weighted by 1 / n. Where the pixel holds a sample of that surface, views looked there,
// and it is not filled: a veil is as thin as they saw it.
//
// It shows what the last pixel of the ground shows; where that holds one sample whose colour is a mixture (deep/unmixing.h) of the
// pixel before it, of the same surface, and of the one that hides it, what the pixel before shows: silhouettes that no view
// unmixed.
//
// A filler lies behind all samples, at the depth of the ground that it continues: a lens point sees it only where it
// meets no opaque sample.
#pragma once

#include "base/large_array.h"
#include "deep/ldi.h"
#include "dof/facets/known_pixels.h"
#include "lens/thin_lens.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

struct Filler {
    struct Part {
        std::uint32_t sample; // of the LDI; `nothing`
        std::uint32_t pixel;  // that has it, of the data window
        float share;          // of the sample's values
    };
    static constexpr std::uint32_t nothing = 0xffffffffu; // transparent to infinity

    std::uint32_t pixel; // of the data window: the filler lies in its middle
    float z;             // scene units
    std::uint32_t count; // of parts, 1 to 4
    std::array<Part, 4> part;

    std::span<const Part> parts() const { return std::span(part).first(count); }
    bool is_nothing() const { return part[0].sample == nothing; }
};

// At most one a pixel, in the order of the pixels. The LDI has less than 2^32 samples and pixels.
LargeArray<Filler> find_fillers(const Ldi &ldi, const ThinLens &lens, const KnownPixels &known);

} // namespace sparselens
