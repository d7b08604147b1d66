// Tiles that are gathered in cells of several pixels.
//
// Far out of focus, a lens leaves no detail as fine as a pixel. If everything that can reach a tile has a CoC of many
// pixels, and no empty background shows, the tile is gathered in cells of 4 x 4 or 8 x 8 pixels, from a small scene
// (gather_scene.h). A cell is the mean of its pixels. Pixels are interpolated from cells along rows, and then along
// columns: a pixel is the mean, over its extent, of the cubic polynomial whose means over the four cells around it are
// those of the cells, limited to their range. The limit applies to each channel alone, so it is left out where sums of
// channels must be kept.
#pragma once

#include "dof/device/tile_device.h"
#include "dof/lens/lens_gather.h"

#include <Imath/ImathVec.h>

#include <array>
#include <vector>

namespace sparselens {

inline constexpr std::array cell_sizes{8, 4}; // pixels, across and down

// Returns the size of the cells of a tile, or 1 for a tile without cells. `least_coc`: the smallest CoC that reaches
// the tile, pixels, without its sign.
int cell_size_for(float least_coc, Quality quality);

// The cells that the pixels of a tile are interpolated from.
struct TileCells {
    int across;             // pixels that a cell is wide and high
    Imath::V2i first_pixel; // of the tile, EXR coordinates
    Imath::V2i first;       // cell; cell (i, j) has the pixels from (i, j) * across on
    int count() const;      // cells across; as many down
};
TileCells cells_of_tile(const Imath::V2i &first_pixel, int across);

// The pixels of a tile.
struct PixelsOfCells {
    std::vector<float> values, known;
    std::size_t groups;

    TilePicture picture() const;
};
enum class CellRange { limited, open };
PixelsOfCells interpolated(const TilePicture &cells, const TileCells &of,
                           CellRange range = CellRange::limited);

} // namespace sparselens
