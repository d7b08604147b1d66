#include "dof/lens/highlights.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

constexpr int neighbourhood = 4;     // blocks wide and high
constexpr std::size_t brightest = 5; // one sample in so many may be a highlight
constexpr float stands_out = 4;      // times what is around
constexpr float smallest_coc = 2;    // pixels

float brightness_of(const SampleColours &colours, std::span<const std::size_t> channels,
                    std::uint32_t sample) {
    float most = 0;
    for (const std::size_t k : channels) most = std::max(most, colours.at(k, sample));
    return most;
}

// The samples of a neighbourhood of blocks.
std::vector<std::uint32_t> samples_around(const BlockedSamples &samples, int column, int row) {
    std::vector<std::uint32_t> found;
    for (int r = row; r < std::min(row + neighbourhood, samples.rows); ++r)
        for (int c = column; c < std::min(column + neighbourhood, samples.columns); ++c) {
            const SampleBlock &block = samples.blocks[std::size_t(r * samples.columns + c)];
            for (std::uint32_t i = block.begin; i < block.end; ++i) found.push_back(i);
        }
    return found;
}

// What all but the brightest stay below: a share of the pixels of a neighbourhood, and at most a third of its samples where
// few of its pixels have any.
float brightness_around(std::vector<float> levels) {
    if (levels.empty()) return 0;
    constexpr std::size_t side = std::size_t(neighbourhood) * BlockedSamples::size;
    const std::size_t few = std::min(std::max(levels.size(), side * side) / brightest, levels.size() / 3);
    const auto limit = levels.end() - 1 - std::ptrdiff_t(few);
    std::nth_element(levels.begin(), limit, levels.end());
    return *limit;
}

struct Found {
    std::uint32_t sample;
    float share; // of its light that is spread, (0, 1]
};

std::vector<Found> find_highlights(const BlockedSamples &samples, std::span<const std::size_t> channels,
                                   const SampleColours &colours, int column, int row) {
    const std::vector<std::uint32_t> around = samples_around(samples, column, row);
    std::vector<float> levels;
    for (const std::uint32_t i : around) levels.push_back(brightness_of(colours, channels, i));
    std::vector<Found> found;
    const float level = brightness_around(levels);
    for (std::size_t i = 0; i < around.size(); ++i)
        if (levels[i] > stands_out * level && std::abs(samples.coc[around[i]]) >= smallest_coc)
            found.push_back({around[i], 1 - level / levels[i]});
    return found;
}

} // namespace

Highlights take_highlights(const BlockedSamples &samples, std::span<const std::size_t> brightness,
                           std::span<const std::size_t> colour_channels, SampleColours &colours) {
    const int columns = (samples.columns + neighbourhood - 1) / neighbourhood;
    const int rows = (samples.rows + neighbourhood - 1) / neighbourhood;
    std::vector<std::vector<Found>> found(std::size_t(columns) * std::size_t(rows));
    parallel_for(found.size(), [&](std::size_t i) {
        const int column = int(i) % columns * neighbourhood, row = int(i) / columns * neighbourhood;
        found[i] = find_highlights(samples, brightness, colours, column, row);
    });
    std::vector<Found> all;
    for (const auto &some : found) all.insert(all.end(), some.begin(), some.end());
    std::sort(all.begin(), all.end(), [](const Found &a, const Found &b) { return a.sample < b.sample; });
    Highlights highlights{{},
                          {colours.groups, all.size(), std::vector<float>(colours.groups * all.size() * 4)}};
    for (const Found &f : all) {
        for (const std::size_t k : colour_channels) {
            highlights.light.at(k, highlights.sample.size()) = f.share * colours.at(k, f.sample);
            colours.at(k, f.sample) *= 1 - f.share;
        }
        highlights.sample.push_back(f.sample);
    }
    return highlights;
}

} // namespace sparselens
