// The samples of an LDI as the lens gather needs them: a structure of arrays, in blocks of neighbouring pixels whose
// bounds tell at once which lens points bring none of their samples into a tile.
#pragma once

#include "base/channel_kind.h"
#include "base/image.h"
#include "base/light.h"
#include "base/parallel.h"
#include "base/text.h"
#include "deep/ldi.h"
#include "kernels/lens_rules.h"
#include "lens/thin_lens.h"

#include <Imath/ImathBox.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

// The known pixels of an LDI: they are transparent to infinity where nothing covers them. In other pixels it is unknown
// what lies behind the samples.
struct KnownPixels {
    // The pixels of `window` (EXR coordinates) are known, except those marked in `unseen`, [pixel of the data window].
    // An empty `unseen` marks none.
    Imath::Box2i window;
    std::span<const char> unseen = {};

    KnownPixels(const Imath::Box2i &window_, std::span<const char> unseen_ = {})
        : window(window_), unseen(unseen_) {}
    bool has(const Windows &windows, std::size_t pixel) const {
        return window.intersects(windows.pixel(pixel)) && (unseen.empty() || !unseen[pixel]);
    }
};

struct SampleBlock {
    std::uint32_t begin, opaque_end, end; // opaque samples, then those of partial coverage
    float x_min, x_max, y_min, y_max;     // of the samples' centres, pixels
    float coc_min, coc_max;               // pixels, signed
    float coc_shown;                      // the largest, without its sign, except of backgrounds
    float coc_least;                      // the smallest, without its sign
    bool shows_opaque;                    // whether it has opaque samples other than backgrounds
    bool shows_images;                    // whether any sample is_image()
    bool has_background;                  // whether any sample is a background
    float depth_min, depth_max;           // disparity, pixels: of the farthest sample and the nearest
    float focus_min, focus_max;           // of the sums of CoC and disparity, where it hides
};

struct BlockedSamples {
    // One entry per sample and per background. Backgrounds are opaque, and have no colour and no alpha. A pixel that
    // lets light through to infinity has a background there. If it has samples, it has another one at the position of
    // its last sample, but behind everything else: a lens point that sees the last sample sees through it, even if what
    // lies behind it at infinity is not known.
    LargeArray<float> x, y; // centre, pixels, relative to the data window's corner, y down
    LargeArray<float> coc;  // signed radius, pixels
    // If an opaque sample shows an image (Ldi::image_z), `coc` is the CoC of the image, by which its colour moves.
    // `surface_coc` is the CoC of the surface, which decides where the mirror is seen at all. Empty if there are no
    // images.
    LargeArray<float> surface_coc;
    LargeArray<float> alpha;         // coverage, (0, 1]
    LargeArray<std::uint32_t> upper; // says the depth (kernels/lens_rules.h)
    // The sample that a filler or solid (fillers.h) shows. Empty: each shows itself.
    LargeArray<std::uint32_t> named;
    LargeArray<std::uint32_t> source; // index into the LDI's samples; `background` for the background
    static constexpr std::uint32_t background = 0xffffffffu;

    std::vector<SampleBlock> blocks; // row by row
    int columns = 0, rows = 0;       // of blocks
    static constexpr int size = 8;   // pixels a block is wide and high

    std::size_t count() const { return x.size(); }
    // Disparity, pixels: larger is nearer.
    float depth(std::size_t i) const { return kernels::depth_of(upper[i]); }
    bool is_image(std::size_t i) const { return !surface_coc.empty() && surface_coc[i] != coc[i]; }
    // The CoCs that move what hides other samples.
    const LargeArray<float> &hiding_coc() const { return surface_coc.empty() ? coc : surface_coc; }
};

inline float largest_coc_of(const SampleBlock &block) {
    return std::max(std::abs(block.coc_min), std::abs(block.coc_max));
}

// Sets the bounds of a block, whose samples are already in `samples`.
void bound(SampleBlock &block, const BlockedSamples &samples);

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
    std::uint32_t named = 0;
};
enum class Also { nothing, surfaces, names }; // which array is filled, too: surface_coc, or named

struct SampleCounts {
    std::uint32_t opaque = 0, all = 0;
};

// Makes blocks of the samples that `place(x, y, placed)` appends for each column and row of a window of this size;
// `count` says how many that will be, so that they need not be kept twice.
using CountSamples = std::function<SampleCounts(const Position &at)>;
using PlaceSamples = std::function<void(const Position &at, std::vector<PlacedSample> &placed)>;
BlockedSamples make_blocks(const Windows &windows, const CountSamples &count, const PlaceSamples &place,
                           Also also);
// The same for opaque samples. Calls place() twice for each pixel: to count its samples, and to store them.
BlockedSamples make_blocks(const Windows &windows, const PlaceSamples &place, Also also = Also::nothing);

// Colours of the samples of a BlockedSamples, in groups of four channels so that one load brings one group:
// [group][sample][4], premultiplied; channel k of the LDI is entry k % 4 of group k / 4.

// The kind of a channel, for a lens that treats colours differently; one bit each, so that kinds form sets.
enum ColourSet : std::uint8_t {
    red = kernels::is_red,
    green = kernels::is_green,
    blue = kernels::is_blue,
    coverage = kernels::is_coverage,
    data = kernels::is_data,
    all_colours = 31
};
inline bool is_colour(ColourSet set) { return (set & (red | green | blue)) != 0; }

struct SampleColours {
    std::size_t groups = 0, count = 0; // of channels / 4, of samples
    LargeArray<float> values;
    std::vector<ColourSet> sets = {}; // [channel], of all groups; the channels that fill up the last are data

    std::span<const float> group(std::size_t g) const {
        return std::span(values).subspan(g * count * 4, count * 4);
    }
    float &at(std::size_t channel, std::size_t sample) {
        return values[(channel / 4 * count + sample) * 4 + channel % 4];
    }
    float at(std::size_t channel, std::size_t sample) const {
        return values[(channel / 4 * count + sample) * 4 + channel % 4];
    }
};

// `count` >= the number of channels.
inline std::vector<ColourSet> colour_sets(const Ldi &ldi, std::size_t count) {
    std::vector<ColourSet> sets(count, data);
    constexpr std::array of_part{data, red, green, blue, coverage};
    for (std::size_t k = 0; k < ldi.channels.size(); ++k)
        sets[k] = of_part[std::size_t(colour_part(ldi.channels[k]))];
    return sets;
}

inline SampleColours make_colours(const Ldi &ldi, const BlockedSamples &samples) {
    const std::size_t channels = ldi.channels.size(), groups = (channels + 3) / 4, count = samples.count();
    SampleColours colours{groups, count, LargeArray<float>(groups * count * 4), colour_sets(ldi, groups * 4)};
    parallel_ranges(count, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t k = 0; k < groups * 4; ++k) {
                const bool has_value = k < channels && samples.source[i] != BlockedSamples::background;
                colours.at(k, i) = has_value ? ldi.values[k][samples.source[i]] : 0;
            }
    });
    return colours;
}

// Channels that are light, without coverage; and those of them that say how bright a sample is: R, G and B, or the Y of
// a grey picture.
struct LightChannels {
    std::vector<std::size_t> all, brightness;
};

inline LightChannels light_channels(const Ldi &ldi) {
    LightChannels light;
    const bool grey = find_channel(ldi.channels, rgb_names[0]) == npos;
    for (std::size_t k = 0; k < ldi.channels.size(); ++k) {
        const Channel &channel = ldi.channels[k];
        if (!is_light(channel) || k == ldi.alpha()) continue;
        light.all.push_back(k);
        if (grey ? channel.name == "Y" : is_among(rgb_names, channel.name)) light.brightness.push_back(k);
    }
    return light;
}

} // namespace sparselens
