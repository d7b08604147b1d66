// The samples of an LDI as the lens gather needs them: a structure of arrays, in blocks of neighbouring pixels whose
// bounds tell at once which lens points bring none of their samples into a tile.
#pragma once

#include "base/coverage.h"
#include "base/large_array.h"
#include "deep/ldi.h"
#include "dof/facets/known_pixels.h"
#include "kernels/lens_rules.h"
#include "lens/thin_lens.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace sparselens {

struct SampleBlock {
    std::uint32_t begin, opaque_end, end; // opaque samples, then those of partial coverage
    float x_min, x_max, y_min, y_max;     // of the samples' centres, pixels
    float coc_min, coc_max;               // pixels, signed
    float coc_shown;                      // the largest, without its sign, except of backgrounds
    float coc_least;                      // the smallest, without its sign
    bool shows_opaque;                    // whether it has opaque samples other than backgrounds
    bool shows_images;                    // whether any sample is_image()
    bool has_background;                  // whether any sample is a background
    float depth_min, depth_max;           // perceptive, pixels: of the farthest sample and the nearest
};

struct BlockedSamples {
    // One entry per sample and per background. Backgrounds are opaque, and have no colour and no alpha. A pixel that
    // lets light through to infinity has a background there. If it has samples, it has another one at the position of
    // its last sample, but behind everything else: a lens point that sees that sample sees through it, even if what
    // lies behind it at infinity is not known.
    LargeArray<float> x, y; // centre, pixels, relative to the data window's corner, y down
    LargeArray<float> coc;  // signed radius, pixels
    // If an opaque sample shows an image (Ldi::optical), `coc` is the CoC of the image, by which its colour moves.
    // `surface_coc` is the CoC of the surface, which decides where the mirror is seen at all. Empty if there are no
    // images.
    LargeArray<float> surface_coc;
    LargeArray<float> alpha;         // coverage, (0, 1]
    LargeArray<std::uint32_t> upper; // the upper half of the key (kernels/lens_rules.h), which says the depth
    // For solids (solid_samples.h): what the lower half of the key names. Empty: the sample itself.
    LargeArray<std::uint32_t> named;
    LargeArray<std::uint32_t> source; // index into the LDI's samples; `background` for the background
    static constexpr std::uint32_t background = 0xffffffffu;

    std::vector<SampleBlock> blocks; // row by row
    int columns = 0, rows = 0;       // of blocks
    static constexpr int size = 8;   // pixels a block is wide and high

    std::size_t count() const { return x.size(); }
    // Perceptive, pixels: larger is nearer.
    float depth(std::size_t i) const { return kernels::depth_of(upper[i]); }
    // Nearer is greater, no two are equal. Never 0.
    std::uint64_t key(std::size_t i) const {
        return kernels::key_of(upper[i], named.empty() ? std::uint32_t(i) : named[i]);
    }
    bool is_image(std::size_t i) const { return !surface_coc.empty() && surface_coc[i] != coc[i]; }
    // The CoCs that move what hides other samples.
    const LargeArray<float> &hiding_coc() const { return surface_coc.empty() ? coc : surface_coc; }
};

inline float largest_coc_of(const SampleBlock &block) {
    return std::max(std::abs(block.coc_min), std::abs(block.coc_max));
}

// Sets the bounds of a block, whose samples are already in `samples`.
void bound(SampleBlock &block, const BlockedSamples &samples);

// A background lies behind what the LDI has at infinity.
inline bool is_background(std::uint64_t key) { return kernels::upper_of(key) <= kernels::background_upper; }

// `known`: the pixels that are transparent to infinity where nothing covers them. Throws Error if the LDI has more
// samples than 32 bits count.
BlockedSamples make_blocks(const Ldi &ldi, const ThinLens &lens, const KnownPixels &known);

// Finds where the samples of some rows of an LDI are in `samples`. The rows [top, bottom) are those of whole blocks.
class SamplePlaces {
public:
    SamplePlaces(const BlockedSamples &samples, const Ldi &ldi, int top, int bottom);
    std::uint32_t of(std::uint64_t sample) const { return places_[sample - first_]; }

private:
    std::uint64_t first_;
    std::vector<std::uint32_t> places_;
};

// Returns where one sample of the LDI is in `samples`. `pixel`: the pixel of the data window that has it.
std::uint32_t place_of(const BlockedSamples &samples, const Ldi &ldi, std::size_t pixel,
                       std::uint64_t sample);

struct PlacedSample {
    float x, y, coc, depth, alpha;
    std::uint32_t source;
    std::optional<float> surface_coc = {}; // else coc
};

struct SampleCounts {
    std::uint32_t opaque = 0, all = 0;
};

// Makes blocks of the samples that `place(x, y, placed)` appends for each column and row of a window of this size;
// `count` says how many that will be, so that they need not be kept twice.
using CountSamples = std::function<SampleCounts(int x, int y)>;
using PlaceSamples = std::function<void(int x, int y, std::vector<PlacedSample> &placed)>;
BlockedSamples make_blocks(const Windows &windows, const CountSamples &count, const PlaceSamples &place,
                           bool images = false);

} // namespace sparselens
