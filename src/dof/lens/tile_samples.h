// The samples that lens points see in a tile, copied once for all of them, so that what a lens point sees of a cell is
// one word.
//
// Each sample of a tile has a number. A word has a depth code (kernels/lens_rules.h) in its upper bits and the number in
// its lower bits, so the sample with the greater word is nearer. Numbers descend: if samples have the same code, the first
// one has the greatest word. It is the nearest one, because the samples of a pixel are sorted front to back.
#pragma once

#include "dof/device/tile_device.h"
#include "dof/lens/gather_scene.h"
#include "dof/lens/tile_projection.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// Samples that follow each other, and have numbers from `number` on downwards. Fillers come after all samples.
struct NumberRun {
    std::uint32_t begin, end, number;
    bool has(std::uint32_t sample) const { return sample - begin < end - begin; }
};

// The numbers of a tile: of the opaque samples of its blocks, of others that its facets and solids show, and of its
// fillers. 0 is nothing.
struct TileNumbers {
    std::vector<NumberRun> runs; // in ascending order of samples; the last number is 1
    int bits = 0;                // of a word; codes have the rest
    kernels::TileUnits units{};

    std::size_t count() const { return runs.empty() ? 1 : runs.front().number + 1; } // with nothing
};
TileNumbers number_tile(const GatherScene &scene, const TileTask &tile);

// Samples of some blocks, placed for a tile, and what they show.
struct PlacedWords {
    WholePlaces places;
    std::vector<CellWord> words;         // of each place; 0 where there is no sample
    std::vector<std::uint32_t> begin{0}; // [block of the tile]: its first place; and the end
};

// How far lens points move a sample, in pixels: `x` and `y` for each pixel of its CoC, and `beside` more.
struct LensReach {
    float x = 0, y = 0, beside = 0;
    LensReach(std::span<const LensSample> lens);
    // Whether some lens point brings a sample into a square of pixels, or next to it.
    bool brings(const BlockedSamples &samples, std::uint32_t i, const Imath::V2i &corner, int size) const;
};

// Returns the samples of partial coverage that a tile's lens points may see: front to back, and in ascending order
// where depths are equal.
std::vector<std::uint32_t> partial_in_reach(const BlockedSamples &samples, const TileTask &tile);

// Samples of partial coverage that a tile may see, front to back. They are many, so each array has them in that order.
struct PartialSamples {
    std::vector<std::uint32_t> sample; // of the BlockedSamples
    std::vector<float> coc, depth;
    std::vector<float> left; // what each leaves of the light behind it
    PlacedWords placed;      // words that hide an opaque sample of the same depth, too

    std::size_t count() const { return sample.size(); }
};

class TileSamples {
public:
    // `scene` and `tile` must not change meanwhile.
    TileSamples(const GatherScene &scene, const TileTask &tile);

    const kernels::TileUnits &units() const { return numbers_.units; }
    std::uint32_t code_of(CellWord word) const { return std::uint32_t(word) >> numbers_.bits; }
    // Returns a word with another code. 0 gives the least word that shows the number.
    CellWord word_of(std::uint32_t code, CellWord number) const {
        return CellWord(code << numbers_.bits) | number;
    }
    CellWord number_mask() const { return word_of(1, 0) - 1; }
    std::uint32_t number_of(CellWord word) const { return std::uint32_t(word & number_mask()); }

    PlacedWords opaque, solids, fillers;
    PlacedWords images; // samples of mirrors and glass, where their images move, by codes of images
    PartialSamples partial;
    std::vector<std::array<CellWord, 3>> facets; // of the tile's blocks, in their order
    bool is_deep = false;                        // whether a crack may lie between the depths of two samples

    // Arrays by number:
    struct Shown {
        float x = 0, y = 0, depth = 0; // pixels
        std::uint32_t sample = 0;      // of the scene, if it is no filler
    };
    std::vector<Shown> shown;
    std::vector<char> in_front; // of focus; 1: yes
    std::span<const float> colours(std::size_t group) const {
        return std::span(colours_).subspan(group * shown.size() * 4, shown.size() * 4);
    }

private:
    void name(const NumberRun &run);
    CellWord number(std::uint32_t sample);
    std::uint32_t code(std::uint32_t upper) const;
    void place(PlacedWords &to, const BlockedSamples &samples, std::span<const float> coc,
               std::span<const std::uint32_t> blocks, std::size_t offset);
    void place(PlacedWords &to, std::span<const std::uint32_t> list);
    void place_images();
    void place_partial();

    const GatherScene &scene_;
    const TileTask &tile_;
    TileNumbers numbers_;
    Imath::V2f middle_;
    std::size_t last_run_ = 0; // that number() found
    LargeArray<float> colours_;
};

} // namespace sparselens
