// One tile of the lens picture: every lens point sees its own picture of the samples, each a square one pixel
// wide and high, the nearest opaque one in front; the mean over the lens points is the tile.
//
// Samples of partial coverage are composited front to back over the opaque one behind them. What a lens point sees
// that meets nothing opaque, and what of it is unknown, lens_gather_reference.h says, and does slowly. Where it is
// unknown, only the light in front of it counts, and the weights are renormalised.
#pragma once

#include "base/float4.h"
#include "deep/holdout.h"
#include "dof/facets/placed_facets.h"
#include "dof/lens/fillers.h"
#include "dof/lens/sample_blocks.h"
#include "dof/lens/sample_colours.h"
#include "dof/lens/tile_projection.h"
#include "kernels/lens_layout.h"
#include "lens/cat_eye.h"
#include "lens/lens_samples.h"

#include <Imath/ImathBox.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// What holds the picture out, and what its lookups need to be told.
struct HeldOut {
    const Holdout *by = nullptr;
    double depth_at_1 = 1;   // perceptive depth at z = 1
    Imath::V2i corner{0, 0}; // of the data window that the samples are relative to, EXR coordinates

    // The share of light from that perceptive depth that passes at a pixel, relative to `corner`; `by` is given.
    float passes(const Imath::V2i &pixel, float depth) const;
};

class LensTile {
public:
    static constexpr int size =
        lens_kernel::tile_size; // pixels wide and high: the buffers of a lens point stay in the cache

    // What is gathered from: blocks of samples, of facets between them, and of fillers.
    struct Blocks {
        std::vector<std::uint32_t> samples, facets, fillers;
    };

    LensTile(const BlockedSamples &samples, const SampleColours &colours, const PlacedFacets &facets,
             const FillerSamples &fillers, const HeldOut &held_out = {}, const CatEye *cat_eye = nullptr);

    // Gathers the pixels [origin, origin + size), relative to the data window's corner like the samples, from
    // the blocks that can reach them or the pixels next to them.
    void gather(const Imath::V2i &origin, const Blocks &blocks, std::span<const LensSample> lens);

    // The mean over the known lens points at a pixel of the tile; past a cat-eye, over those that it lets through, also
    // where it darkens. `known`: one is.
    bool known(int x, int y) const;
    float value(int x, int y, std::size_t channel) const;

private:
    // The buffers have a border of one pixel, and one of cells that take what falls outside of that.
    static constexpr int border = lens_kernel::border, stride = lens_kernel::tile_stride;
    static std::size_t cell_of(int x, int y) { return std::size_t((y + border) * stride + x + border); }
    static int column_of(std::size_t cell) { return int(cell) % stride - border; }
    static int row_of(std::size_t cell) { return int(cell) / stride - border; }
    struct Cells { // by the pixels of the tile, right and bottom excluded
        int left, top, right, bottom;
    };
    static constexpr Cells everywhere{1 - border, 1 - border, size + border - 1, size + border - 1};

    float known_weight(int x, int y) const; // of the lens points; 0: none
    void collect_partial(std::span<const LensSample> lens);
    bool in_reach(std::uint32_t sample) const;
    void see_opaque(const LensSample &lens, const BlockedSamples &samples, BlockBounds &bounds,
                    const Cells &seen, std::vector<std::uint64_t> &front) const;
    void see_facets(const LensSample &lens);
    // Of images (lens_tile_unseen.cpp).
    void see_images(const LensSample &lens);
    std::uint64_t image_at(std::size_t cell) const;
    const std::vector<std::uint64_t> &shown() const { return sees_images_ ? shown_ : front_; }
    std::uint64_t torn_at(std::size_t cell) const;
    void find_cracks();
    void close_cracks();
    void see_fillers(const LensSample &lens);
    void see_partial(const LensSample &lens);
    std::size_t see_partial_alone();
    std::size_t see_partial_by_rules();
    float passes(int x, int y, float depth) const; // of light from there, the holdout
    bool hides(int x, int y, float depth) const;
    const float *opaque_colour(std::size_t group, std::size_t cell) const;
    float opaque_passes(int x, int y) const; // of the light of what is opaque there
    // The same where lens points weigh differently for colours or sides of the focus (lens_tile_weights.cpp).
    void begin_weighted(std::span<const LensSample> lens);
    void find_columns(const LensSample &lens);
    void weigh_channels(const LensSample &lens);
    void count_columns();
    std::size_t counted_rows() const { return cat_eye_ ? size : 1; } // without a cat-eye, all are alike
    void sum_up_known();
    bool seen_by_none() const; // of the tile's pixels, past the cat-eye
    bool in_columns(int x, int y) const {
        return x >= columns_[std::size_t(y)].begin && x < columns_[std::size_t(y)].end;
    }
    bool is_darkened(std::size_t channel) const {
        return kernels::is_darkened(colours_.sets[channel], cat_eye_ && cat_eye_->darkens());
    }
    Float4 known_in_front(std::size_t group) const;
    void count_in_front(std::size_t at, float share); // an index of sums_
    float known_of(std::size_t at) const;             // weight of what is known, an index of sums_
    bool in_front(std::uint32_t sample) const { return two_sided_ && samples_.coc[sample] < 0; }
    bool opaque_in_front(std::size_t cell) const;
    using Weights = std::array<std::vector<float>, 2>; // [side][channel]; side 1 is in front
    void add_opaque_weighted();
    template <bool two_sided>
    void add_row_weighted(int y, std::size_t &empty);
    void add_unseen_weighted();
    void add_partial_weighted();
    void add_partial_weighted(int x, int y, std::size_t group);
    void add_opaque(float weight);
    void add_unseen(float weight);
    void add_partial(float weight);
    void forget_partial();

    const BlockedSamples &samples_;
    const SampleColours &colours_;
    const PlacedFacets &facets_;
    const FillerSamples &fillers_;
    HeldOut held_out_;
    const CatEye *cat_eye_;
    float origin_x_ = 0, origin_y_ = 0;
    float total_ = 0; // weight of the lens points
    const Blocks *blocks_ = nullptr;
    BlockBounds bounds_, filler_bounds_; // of its blocks of samples, of fillers
    // Samples of partial coverage, front to back.
    struct Partial {
        std::vector<std::uint64_t> order; // to sort them by
        std::vector<std::uint32_t> sample;
        std::vector<float> x, y, coc, left; // of each, side by side; what it leaves of the light behind it
        std::vector<std::uint64_t> key;
        std::vector<float> colours;     // [group][of each][4]
        std::vector<std::int32_t> cell; // where the lens point at hand sees it
    } partial_;
    float reach_x_ = 0, reach_y_ = 0; // of the lens points, for each pixel of CoC
    // Of one lens point:
    std::vector<std::uint64_t> front_; // [cell]: key of the nearest opaque sample; 0: none
    bool sees_images_ = false;
    std::vector<std::uint64_t> shown_; // [cell], if sees_images_: key of the sample whose colour front_ shows
    std::vector<std::uint32_t>
        image_; // [cell]: the nearest image that lies there, as its sample's index plus one
    std::vector<std::uint64_t> filler_; // [cell]: of those in empty_: key of the filler that shows; 0: none
    std::vector<std::uint32_t> empty_cells_;
    std::span<const std::uint32_t> empty_; // cells of the tile's pixels without any
    std::vector<std::uint32_t> covered_cells_;
    std::span<const std::uint32_t> covered_; // cells with partial samples
    struct Crack {
        std::uint32_t cell;
        std::uint64_t key; // of the sample that shows through it
    };
    std::vector<Crack> cracks_;
    std::vector<float> transmittance_; // [cell]: of the partial samples in front
    std::vector<float> over_; // [side][group][cell][4]: their colours; all on side 0 unless two_sided_
    std::vector<float> hidden_in_front_; // [cell]: what those in front of focus hide, if two_sided_
    // Of all so far:
    std::vector<float> sums_;    // [group][pixel][4]
    std::vector<float> unknown_; // [pixel]: weight of the lens points that see nothing
    // Of lens points that weigh differently:
    bool weighted_ = false, two_sided_ = false;
    Weights light_weights_, // of the lens point: by what light is multiplied,
        known_weights_;     // and how it counts in what the sum is divided by
    std::vector<double>
        steps_; // [group][counted row][column][4]: how much more the pixels from that column on see
    std::vector<double> known_; // as sums_: how much of it is known, as if all of it were behind focus
    std::vector<float> known_in_front_; // as sums_, if two_sided_: how much more as part of it is in front
    std::array<CatEye::Columns, size> columns_; // [row]: the pixels that see through the lens point
};

} // namespace sparselens
