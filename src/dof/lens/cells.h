// Tiles that are gathered in cells of several pixels.
//
// A lens leaves no detail as fine as a pixel in what lies far out of focus: where everything that can reach a tile has a CoC of
// many pixels, and no empty background shows, it is gathered in cells of 4 x 4 or 8 x 8 pixels, from a small scene
// (gather_scene.h). A cell is the mean of its pixels. Along a row, and then along a column, a pixel is the mean that the cubic
// polynomial has there which has the means of the four cells around it, but no more and no less than these. That limit is of
// each channel alone: where channels have a sum that is to be kept, it is left out.
#pragma once

#include "dof/device/tile_device.h"
#include "dof/lens/lens_gather.h"

#include <Imath/ImathVec.h>

#include <array>
#include <vector>

namespace sparselens {

inline constexpr std::array cell_sizes{8, 4}; // pixels, across and down

// The size of the cells of a tile that nothing reaches which has a smaller CoC (pixels, without its sign); 1 where it has none.
int cell_size_for(float least_coc, Quality quality);

// The cells that the pixels of a tile are made of.
struct TileCells {
    int across;             // pixels that a cell is wide and high
    Imath::V2i first_pixel; // of the tile, EXR coordinates
    Imath::V2i first;       // cell; cell (i, j) has the pixels from (i, j) * across on
    int count() const;      // across and down
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
