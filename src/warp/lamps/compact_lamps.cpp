#include "warp/lamps/compact_lamps.h"

#include "base/median.h"
#include "base/parallel.h"
#include "lens/lamp.h"
#include "warp/tuning.h"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace sparselens {

namespace {

struct Seed {
    std::size_t pixel;
    float brightness, surroundings;
};

// Most blocks are found to have no seeds without a median.
std::vector<Seed> seeds_of(const Grid &grid, std::span<const float> brightness, const Imath::Box2i &box) {
    std::vector<float> values;
    values.reserve(std::size_t(WarpTuning::lamp_block * WarpTuning::lamp_block));
    for (int y = box.min.y; y <= box.max.y; ++y) {
        const auto row = brightness.subspan(grid.index(box.min.x, y), std::size_t(box.size().x) + 1);
        values.insert(values.end(), row.begin(), row.end());
    }
    const auto [least, most] = std::ranges::minmax(values);
    if (!stands_out(most, least, LampTuning::stands_out_of_view)) return {};
    const float middle = median(values);
    std::vector<Seed> seeds;
    for (int y = box.min.y; y <= box.max.y; ++y)
        for (int x = box.min.x; x <= box.max.x; ++x) {
            const std::size_t i = grid.index(x, y);
            if (stands_out(brightness[i], middle, LampTuning::stands_out_of_view))
                seeds.push_back({i, brightness[i], middle});
        }
    return seeds;
}

class Grower {
public:
    Grower(const Grid &grid, std::span<const float> brightness)
        : grid_(grid), brightness_(brightness), group_(grid.size()) {}

    // The lamp around a seed; nothing if the seed is in a group already, or if its group is large or beside another
    // one.
    std::optional<CompactLamp> grow(const Seed &seed) {
        if (group_[seed.pixel] != 0) return {};
        CompactLamp lamp{{},
                         std::max(LampTuning::stands_out * seed.surroundings,
                                  WarpTuning::lamp_belongs_to_brightest * seed.brightness),
                         seed.surroundings};
        ++number_;
        box_ = {};
        take(seed.pixel, lamp);
        for (std::size_t next = 0; next < lamp.pixels.size(); ++next)
            if (!take_around(lamp.pixels[next], lamp)) return {};
        return lamp;
    }

private:
    void take(std::size_t pixel, CompactLamp &lamp) {
        group_[pixel] = number_;
        lamp.pixels.push_back(grid_.pixel(pixel));
        box_.extendBy(lamp.pixels.back());
    }

    bool take_around(Imath::V2i at, CompactLamp &lamp) {
        for (int y = at.y - WarpTuning::lamp_gap; y <= at.y + WarpTuning::lamp_gap; ++y)
            for (int x = at.x - WarpTuning::lamp_gap; x <= at.x + WarpTuning::lamp_gap; ++x) {
                if (!grid_.contains(x, y)) continue;
                const std::size_t i = grid_.index(x, y);
                if (!(brightness_[i] > lamp.limit) || group_[i] == number_) continue;
                if (group_[i] != 0) return false;
                take(i, lamp);
            }
        return box_.size().x < WarpTuning::largest_lamp && box_.size().y < WarpTuning::largest_lamp;
    }

    const Grid &grid_;
    std::span<const float> brightness_;
    std::vector<std::uint32_t> group_; // of each pixel, from 1; 0: none
    std::uint32_t number_ = 0;
    Imath::Box2i box_;
};

} // namespace

std::vector<CompactLamp> find_compact_lamps(const Grid &grid, std::span<const float> brightness) {
    const Tiles blocks(grid.box(), WarpTuning::lamp_block);
    std::vector<std::vector<Seed>> found(blocks.count());
    parallel_for(blocks.count(),
                 [&](std::size_t i) { found[i] = seeds_of(grid, brightness, blocks.box(i)); });
    std::vector<Seed> seeds;
    for (const auto &some : found) seeds.insert(seeds.end(), some.begin(), some.end());
    if (seeds.empty()) return {};
    std::ranges::stable_sort(seeds, std::ranges::greater(), &Seed::brightness);
    Grower grower(grid, brightness);
    std::vector<CompactLamp> lamps;
    for (const Seed &seed : seeds)
        if (auto lamp = grower.grow(seed)) lamps.push_back(std::move(*lamp));
    return lamps;
}

} // namespace sparselens
