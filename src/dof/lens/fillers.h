// Fillers: what is assumed to lie where no view could look, by the rule of deep/unseen.h.
//
// The ground of a pixel is the last thing that it holds: if the pixel is transparent, what lies at infinity (nothing);
// else its last sample of half coverage or more. A ground continues along its row and its column behind nearer grounds.
//
// - It reaches n pixels beyond its end while the ground there is nearer by more than one_surface_px and by more than
//   (n - 1) / sqrt(2) pixels of disparity: some point of the lens could see it.
// - It does not continue where the ground is unknown; frame_extension.h says what lies beyond the frame.
// - If several grounds continue into a pixel, the one with the nearest end fills it; if several ends are as near, the
//   farthest ground. The filler is the mean of all that are one surface with it, each weighted by 1 / n.
// - The farthest ground of each direction fills it likewise, if it lies behind that one: where an ear hides a jaw, and
//   both hide a wall, a lens point sees the wall past both.
// - A pixel that holds a sample of that surface is not filled, because views looked there: a veil stays as thin as they
//   saw it.
// - A filler shows what the last pixel of the ground shows; or what the pixel before that shows, if the last one holds
//   one sample whose colour is a mixture (deep/mixed_pixels.h) of that pixel, on the same surface, and of the pixel
//   that hides the ground, as on silhouettes that no view unmixed.
// - It lies behind all samples, at the depth of its ground: a lens point sees it only where it meets no opaque sample.
#pragma once

#include "base/image.h"
#include "deep/ldi.h"
#include "dof/lens/sample_blocks.h"
#include "lens/thin_lens.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace sparselens {

struct Filler {
    struct Part {
        std::uint32_t sample; // of the LDI; or `nothing`
        std::uint32_t pixel;  // of the data window, that has the sample
        float share;          // factor on the sample's values
    };
    static constexpr std::uint32_t nothing = 0xffffffffu; // transparent to infinity

    std::uint32_t pixel; // of the data window: the filler lies in its middle
    float z;             // scene units
    std::uint32_t count; // of parts, 1 to 4
    std::array<Part, 4> part;
    bool is_between; // whether its surface ends on two opposite sides

    std::span<const Part> parts() const { return std::span(part).first(count); }
    bool is_nothing() const { return part[0].sample == nothing; }
};

// Returns at most two fillers per pixel, the nearer first, in the order of the pixels. The LDI must have fewer than 2^32
// samples and pixels.
LargeArray<Filler> find_fillers(const Ldi &ldi, const ThinLens &lens, const KnownPixels &known);

// Fillers as the lens gather needs them: in blocks.
struct FillerSamples {
    BlockedSamples samples; // `source` is the number of the filler, or `background` if it is nothing
    SampleColours colours;
    // The ones that hide lamps (highlight_shadows.h), once more. `source` is the front sample of the pixel, and `named`
    // the sample of the picture that the filler shows.
    BlockedSamples hiding;
};

// `samples`, `colours`: of the LDI that the fillers belong to. The light that highlights spread is no longer in the
// colours, so no lamp continues behind anything. `highlights`: as in Highlights::sample; if it is not set, there are no
// lamps to hide.
//
// Views show a surface as far as something nearer hides the rest. A lens point that looks behind the nearer thing would
// see lamps beside the surface, but the surface may continue there. So its filler hides lamps. This holds if the
// ground, in the last pixel that shows it, is one surface with most of the three by three pixels around: hair is
// thinner, and covers less than its pixels show. It does not hold if the ground is a highlight.
FillerSamples place_fillers(const Ldi &ldi, const ThinLens &lens, std::span<const Filler> fillers,
                            const BlockedSamples &samples, const SampleColours &colours,
                            const std::optional<std::span<const std::uint32_t>> &highlights = {});

// Places the solids behind samples (Ldi::solid), as lens points see them: each such sample once more, farther away by
// its solid.
//
// A lens point that sees something behind a solid sees the solid instead: light finds no way through a gap as narrow as
// what no view saw through. This holds for things at least as far behind the solid as the solid lies behind its sample.
// Cracks and fillers come first: they decide where a lens point meets nothing opaque.
//
// A solid shows the colour of its sample. If the sample covers less than its pixel, as on edges, the solid shows the
// opaque sample of this pixel or one of the eight around it that is nearest in 1 / z and does not lie behind the solid;
// without such a sample there is no solid. Mirrors and glass, which show images, are not solid.

// A filler between two opposite ends of one surface is solid, too, if that surface is as wide as one that hides lamps: it
// hides what is farther by more than one_surface_px, and shows one of the ends.

// Returns the solids in the blocks of the LDI's `samples`, before looks move them (gather_scene.h); no blocks if
// nothing is solid. Their CoC says where solids are seen. Their depth is the depth from which on they hide what is
// farther.
BlockedSamples place_solids(const Ldi &ldi, const ThinLens &lens, std::span<const Filler> fillers,
                            const BlockedSamples &samples);

} // namespace sparselens
