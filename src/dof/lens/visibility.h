// Finds what one point of the lens sees of a tile.
//
// Through a lens point, each sample is a square one pixel wide and high, moved by its circle of confusion, and the
// nearest opaque sample hides what is behind it. lab/reference/lens_gather_reference.h does the same slowly, and says
// what cracks and fillers are.
#pragma once

#include "dof/lens/tile_samples.h"
#include "lens/cat_eye.h"
#include "lens/lens_samples.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// What one lens point sees.
struct Visibility {
    int rows = tile_cells::size; // rows of pixels that are asked for, from the tile's corner on
    std::array<CatEye::Columns, tile_cells::size>
        columns; // [row]: the pixels that see through the lens point
    // [cell]: the word of the nearest opaque sample, or of one that shows through a crack; else of the filler that
    // shows, with code 0; 0: what shows is unknown, or the pixel does not see through the lens point
    std::vector<CellWord> front;
    // [cell]: the same, but with the numbers of what mirrors and glass show; empty: there are none
    std::vector<CellWord> images;
    // [row]: a bit for each of these pixels: whether nothing is known to show
    std::array<std::uint64_t, tile_cells::size> unknown;
    // the cell of each partial sample, which may lie in front of `front` or behind it
    std::vector<std::uint16_t> partial_cells;

    const std::vector<CellWord> &shown() const { return images.empty() ? front : images; }
    // Calls visit(cell) for each of the unknown cells; visit may change its bit.
    template <typename Visit>
    void for_each_unknown(const Visit &visit) const {
        for (int y = 0; y < rows; ++y)
            for (std::uint64_t row = unknown[std::size_t(y)]; row != 0; row &= row - 1)
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

    const TileSamples &samples() const { return samples_; }
    // The result changes when points_at_once more lens points were looked through.
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
        std::size_t cell;
        CellWord word; // of the sample that shows through it
    };
    BlockBounds::Box box_of(const Cells &cells) const;
    void see_columns(const LensSample &point, Visibility &seen) const;
    template <typename Visit>
    void for_cells(const PlacedWords &placed, std::uint32_t begin, std::uint32_t end,
                   const Visit &visit) const;
    template <typename Visit>
    void for_reached(const LensSample &point, const PlacedWords &placed, BlockBounds &bounds,
                     const Cells &box, const Visit &visit) const;
    void see_opaque(const LensSample &point, const PlacedWords &placed, BlockBounds &bounds, const Cells &box,
                    std::vector<CellWord> &front) const;
    void see_images(Visibility &seen);
    CellWord image_at(const Visibility &seen, std::size_t cell) const;
    void find_cracks(Visibility &seen);
    CellWord torn_at(const Visibility &seen, std::size_t cell) const;
    void see_fillers(const LensSample &point, Visibility &seen);
    bool hides(const Visibility &seen, std::size_t cell, std::uint32_t code) const;
    void show(Visibility &seen) const;

    const GatherScene &scene_;
    const TileTask &tile_;
    TileSamples samples_;
    BlockBounds bounds_, filler_bounds_, solid_bounds_; // of its blocks
    // The state of one lens point:
    WholeLens lens_;
    std::vector<CellWord> fillers_; // [cell]
    std::vector<CellWord> images_;  // [cell]: the nearest image that lies there
    std::vector<Crack> cracks_;
    std::array<Visibility, points_at_once> seen_;
    std::size_t next_ = 0; // of these
};

} // namespace sparselens
