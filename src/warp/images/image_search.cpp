#include "warp/images/image_search.h"

#include "base/subpixels.h"
#include "warp/images/neighbours.h"
#include "warp/tuning.h"

#include <cmath>
#include <limits>
#include <utility>

namespace sparselens {

namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t block_pixels = std::size_t(image_block) * image_block;
constexpr std::size_t band_rows = 13; // of blocks: about as high as a tile of the views

// The blocks of a picture of half the size that contain these blocks.
std::vector<std::size_t> halved(const Tiles &tiles, const std::vector<std::size_t> &blocks,
                                const Tiles &half) {
    std::vector<bool> marks(half.count());
    for (const std::size_t block : blocks) {
        const Grid pixels(reduced(tiles.box(block), 2));
        for (std::size_t n = 0; n < pixels.size(); ++n) marks[half.tile_of(pixels.pixel(n))] = true;
    }
    std::vector<std::size_t> found;
    for (std::size_t n = 0; n < marks.size(); ++n)
        if (marks[n]) found.push_back(n);
    return found;
}

// Returns guesses for the blocks that have many depths; nothing if few blocks have.
std::optional<ImageGuesses> guesses_for(const ImageSweep &sweep, const Imath::Box2i &data,
                                        std::vector<std::size_t> blocks) {
    const Tiles tiles(data, image_block);
    std::erase_if(blocks, [&](std::size_t block) { return !sweep.has_many_depths(tiles.box(block)); });
    const bool few = double(blocks.size()) < WarpTuning::image_many_blocks * double(tiles.count());
    if (few || sweep.views()[0].across() >= WarpTuning::image_smallest) return {};
    std::vector<MatchedView> views;
    views.reserve(sweep.views().size());
    for (const MatchedView &view : sweep.views()) views.push_back(view.half());
    const ImageSweep half(views, sweep.unit() / 2);
    const Imath::Box2i half_data = reduced(data, 2);
    return ImageSearch(half, half_data, halved(tiles, blocks, Tiles(half_data, image_block))).guesses();
}

} // namespace

std::vector<float> ImageGuesses::near(const Imath::Box2i &block) const {
    constexpr int reach = WarpTuning::image_guess_reach;
    const Imath::Box2i around = reduced(block, 2);
    std::vector<float> found;
    for (int y = around.min.y - reach; y <= around.max.y + reach; ++y)
        for (int x = around.min.x - reach; x <= around.max.x + reach; ++x)
            if (grid.contains(x, y) && !std::isnan(depths[grid.index(x, y)]))
                found.push_back(2 * depths[grid.index(x, y)]);
    return found;
}

ImageSearch::ImageSearch(const ImageSweep &sweep, const Imath::Box2i &data,
                         const std::vector<std::size_t> &blocks)
    : sweep_(sweep), box_(data), tiles_(data, image_block), guesses_(guesses_for(sweep, data, blocks)),
      blocks_(tiles_.count(), not_searched) {
    // Searches band by band, and goes back to the band above if that has new blocks. So the tiles of the views are made
    // once for a band, not once for each ring of blocks around those that found something.
    const std::size_t columns = std::size_t(tiles_.columns()), in_band = band_rows * columns;
    std::vector<std::vector<std::size_t>> waiting(pieces_of(tiles_.count(), in_band));
    const auto add = [&](std::size_t tile) {
        blocks_[tile] = count_++;
        waiting[tile / in_band].push_back(tile);
    };
    std::ranges::for_each(blocks, add);
    for (std::size_t band = 0; band < waiting.size();) {
        const std::vector<std::size_t> next = std::exchange(waiting[band], {});
        matches.resize(count_ * block_pixels);
        std::vector<std::uint8_t> much(next.size());
        sweep_.go_through(next.size(), columns, [&](std::size_t n) { much[n] = search_tile(next[n]); });
        for (std::size_t n = 0; n < next.size(); ++n)
            if (much[n])
                for_each_beside(tiles_, next[n], [&](std::size_t other) {
                    if (blocks_[other] == not_searched) add(other);
                });
        if (band > 0 && !waiting[band - 1].empty())
            --band;
        else if (waiting[band].empty())
            ++band;
    }
}

std::size_t ImageSearch::index_of(const Imath::V2i &pixel) const {
    if (!box_.intersects(pixel)) return npos;
    const auto x = unsigned(pixel.x - box_.min.x), y = unsigned(pixel.y - box_.min.y);
    constexpr auto side = unsigned(image_block);
    const std::uint32_t block = blocks_[std::size_t(y / side) * std::size_t(tiles_.columns()) + x / side];
    return block == not_searched ? npos : block * block_pixels + (y % side) * side + x % side;
}

// Searches a tile. Returns whether much was found.
bool ImageSearch::search_tile(std::size_t tile) {
    const Imath::Box2i block = tiles_.box(tile);
    const std::vector<ImageMatch> found =
        sweep_.search(block, guesses_ ? std::optional(guesses_->near(block)) : std::nullopt);
    const Grid pixels(block);
    std::size_t count = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        matches[index_of(pixels.pixel(i))] = found[i];
        count += found[i].found;
    }
    return double(count) >= WarpTuning::image_enough_found * double(found.size());
}

ImageGuesses ImageSearch::guesses() const {
    const Grid grid(box_);
    ImageGuesses made{grid, std::vector<float>(grid.size(), unknown)};
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const std::size_t index = index_of(grid.pixel(i));
        if (index != npos && matches[index].found) made.depths[i] = matches[index].depth;
    }
    return made;
}

} // namespace sparselens
