// Finds what one point of the lens sees of a tile.
//
// Through a lens point, each sample is a square one pixel wide and high, moved by its circle of confusion, and the
// nearest opaque sample hides what is behind it. lab/reference/lens_gather_reference.h does the same slowly, and says
// what cracks and fillers are.
#pragma once

#include "dof/device/tile_device.h"
#include "dof/lens/gather_scene.h"
#include "dof/lens/lens_gather.h"
#include "dof/lens/sample_blocks.h"
#include "dof/lens/tile_projection.h"
#include "kernels/lens_rules.h"
#include "lens/cat_eye.h"
#include "lens/lens_samples.h"

#include <Imath/ImathVec.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// Samples of partial coverage that a tile may see, front to back. What is needed of them is stored contiguously in that
// order, because they are many.
struct PartialSamples {
    std::vector<std::uint32_t> sample; // of the BlockedSamples
    std::vector<float> x, y, coc, depth;
    std::vector<float> left; // what each leaves of the light behind it
    std::vector<std::uint64_t> key;

    std::size_t count() const { return sample.size(); }
};

// The samples that some lens point brings into the tile, or into a pixel next to it.
PartialSamples partial_samples_of(const BlockedSamples &samples, const TileTask &tile);

// The cells of a tile: its pixels, a border of one pixel around them, and a border of cells that take what falls
// outside of both.
namespace tile_cells {
using lens_kernel::border, lens_kernel::tile_stride;
constexpr int size = lens_tile_size, stride = tile_stride;
static_assert(size == lens_kernel::tile_size);
constexpr std::size_t count = std::size_t(stride * stride), pixels = std::size_t(size * size);
constexpr std::size_t at(int x, int y) { return std::size_t((y + border) * stride + x + border); }
constexpr int column(std::size_t cell) { return int(cell) % stride - border; }
constexpr int row(std::size_t cell) { return int(cell) / stride - border; }
} // namespace tile_cells

// The lower half of a key names a sample of the picture, or a filler.
struct Visibility {
    Imath::V2i origin;           // the tile's first pixel, relative to the data window's corner
    int rows = tile_cells::size; // rows of pixels that are asked for, from `origin` on
    PartialSamples partial;
    // State of one lens point:
    std::array<CatEye::Columns, tile_cells::size> columns; // [row]: the pixels that see through it
    // [cell]: key of the nearest opaque sample, or of one that shows through a crack; 0: none
    std::vector<std::uint64_t> front;
    // [cell]: the same, but with the keys of what mirrors and glass show; empty: there are none
    std::vector<std::uint64_t> images;
    // [row]: a bit for each of these pixels: whether it has no key in `front`
    std::array<std::uint64_t, tile_cells::size> empty;
    std::vector<std::uint64_t> filler; // [cell], if it is empty: key of the filler that shows; 0: unknown
    // the cell of each partial sample, which may lie in front of `front` or behind it
    std::vector<std::int32_t> partial_cells;

    const std::vector<std::uint64_t> &shown() const { return images.empty() ? front : images; }
    // Calls visit(cell) for each empty cell; visit may fill it.
    template <typename Visit>
    void for_each_empty(const Visit &visit) const {
        for (int y = 0; y < rows; ++y)
            for (std::uint64_t row = empty[std::size_t(y)]; row != 0; row &= row - 1)
                visit(tile_cells::at(std::countr_zero(row), y));
    }
    bool sees_through(int x, int y) const { // of the tile
        return x >= columns[std::size_t(y)].begin && x < columns[std::size_t(y)].end;
    }
};

class VisibilityPass {
public:
    // Looks at a tile. `scene` and `tile` must not change meanwhile.
    VisibilityPass(const GatherScene &scene, const TileTask &tile);

    // Before any lens point: the tile, and its partial samples.
    const Visibility &seen() const { return seen_; }
    // The result changes with the next lens point.
    const Visibility &through(const LensSample &point);

private:
    struct Cells { // in pixels of the tile, right and bottom excluded
        int left, top, right, bottom;
    };
    Cells everywhere() const {
        constexpr int beside = tile_cells::border - 1;
        return {-beside, -beside, tile_.size + beside, tile_.size + beside};
    }
    struct Crack {
        std::uint32_t cell;
        std::uint64_t key; // of the sample that shows through it
    };
    bool is_deep() const;
    TileProjection projection(const LensSample &point) const;
    BlockBounds::Box box_of(const Cells &cells) const;
    void see_columns(const LensSample &point);
    void see_opaque(const LensSample &point, const BlockedSamples &samples, BlockBounds &bounds,
                    const Cells &seen, std::vector<std::uint64_t> &front) const;
    void see_facets(const LensSample &point);
    void see_solids(const LensSample &point);
    void see_images(const LensSample &point);
    void find_images(const TileProjection &projection, const SampleBlock &block);
    std::uint64_t image_at(std::size_t cell) const;
    void find_empty();
    void find_cracks();
    void find_cracks_before_others();
    std::uint64_t torn_at(std::size_t cell) const;
    void see_fillers(const LensSample &point);
    bool hides(std::size_t cell, float depth) const;
    void close_cracks();

    const GatherScene &scene_;
    const TileTask &tile_;
    BlockBounds bounds_, filler_bounds_, solid_bounds_; // of its blocks
    // [cell]: the nearest image that lies there, as its sample's index plus one
    std::vector<std::uint32_t> image_;
    std::vector<Crack> cracks_;
    bool is_deep_ = true;
    std::vector<float> depths_; // [cell]: of what is in front there
    Visibility seen_;
};

// Tests several cells of a tile at once: which of them are empty, and where a crack may lie. The results are
// the same on every processor.

// Returns a bit for each of 64 keys: whether it is 0.
std::uint64_t zeros_of(const std::uint64_t *keys);

// Writes the disparity, in pixels, of each key (kernels/lens_rules.h).
void depths_of(std::span<const std::uint64_t> keys, float *depths);

// Returns a bit for each of 64 cells: whether it shows something farther than the cells on two opposite sides of it, so
// that a crack may lie there. `pitch`: from one row to the next. The cells around the 64 are read as well.
std::uint64_t far_behind(const float *depths, std::ptrdiff_t pitch);

} // namespace sparselens
