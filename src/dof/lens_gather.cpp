#include "dof/lens_gather.h"

#include "base/parallel.h"
#include "dof/lens_tile.h"
#include "dof/sample_blocks.h"
#include "dof/sharpen.h"
#include "lens/lens_samples.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace sparselens {

namespace {

SampleColours make_colours(const Ldi &ldi, const BlockedSamples &samples) {
    SampleColours colours;
    const std::size_t channels = ldi.channels.size(), count = samples.count();
    colours.groups = (channels + 3) / 4;
    colours.count = count;
    colours.values.assign(colours.groups * count * 4, 0);
    parallel_runs(count, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t k = 0; k < channels && samples.source[i] != BlockedSamples::background; ++k)
                colours.at(k, i) = ldi.values[k][samples.source[i]];
    });
    return colours;
}

// Channels that are light: all but coverage and ids; and those of them that say how bright a sample is.
struct LightChannels {
    std::vector<std::size_t> all, brightness;
};

LightChannels light_channels(const Ldi &ldi) {
    LightChannels light;
    for (std::size_t k = 0; k < ldi.channels.size(); ++k) {
        const Channel &channel = ldi.channels[k];
        if (channel.type == PixelType::uint32 || k == ldi.alpha()) continue;
        light.all.push_back(k);
        if (channel.name == "R" || channel.name == "G" || channel.name == "B") light.brightness.push_back(k);
    }
    return light;
}

// Ids cannot be averaged: as in the flattened picture they are the front samples'.
void copy_ids(const Ldi &ldi, Image &out) {
    const auto is_id = [](const Channel &channel) { return channel.type == PixelType::uint32; };
    if (std::none_of(ldi.channels.begin(), ldi.channels.end(), is_id)) return;
    const Image flat = crop(flatten(ldi), out.windows.data);
    for (std::size_t k = 0; k < ldi.channels.size(); ++k)
        if (is_id(ldi.channels[k])) std::ranges::copy(flat.plane(k), out.plane(k).begin());
}

float largest_coc(const SampleBlock &block) { return std::max(std::abs(block.coc_min), std::abs(block.coc_max)); }

} // namespace

Image lens_gather(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                  const LensGatherOptions &options, Progress &progress) {
    const BlockedSamples samples = make_blocks(ldi, lens, window);
    SampleColours colours = make_colours(ldi, samples);
    sharpen_near_focus(ldi, lens, samples, colours);
    const LightChannels light = light_channels(ldi);
    const Highlights highlights = take_highlights(samples, light.brightness, light.all, colours);
    Windows windows = ldi.windows;
    windows.data = window;
    Image out(windows, ldi.channels);
    const std::vector<LensSample> points = disc_lens_samples(std::size_t(options.lens_samples ? options.lens_samples : 256), lens.pixel_aspect);
    const NearestLensPoint nearest(points);
    const int columns = (windows.width() + LensTile::size - 1) / LensTile::size;
    const int rows = (windows.height() + LensTile::size - 1) / LensTile::size;
    const Imath::V2i offset = window.min - ldi.windows.data.min;
    progress.start("gathering", std::size_t(columns * rows));
    tbb::enumerable_thread_specific<LensTile> tiles([&] { return LensTile(samples, colours, highlights); });
    parallel_for(std::size_t(columns * rows), [&](std::size_t t) {
        const Imath::V2i corner(int(t) % columns * LensTile::size, int(t) / columns * LensTile::size);
        const Imath::V2i origin = corner + offset;
        std::vector<std::uint32_t> blocks;
        for (std::uint32_t b = 0; b < samples.blocks.size(); ++b) {
            const SampleBlock &block = samples.blocks[b];
            if (block.begin == block.end) continue;
            const float r = largest_coc(block) * float(std::max(1.0, lens.pixel_aspect)) + 1;
            if (block.x_max + r < float(origin.x) || block.x_min - r > float(origin.x + LensTile::size) ||
                block.y_max + r < float(origin.y) || block.y_min - r > float(origin.y + LensTile::size))
                continue;
            blocks.push_back(b);
        }
        LensTile &tile = tiles.local();
        tile.gather(origin, blocks, points,
                    highlight_pixels(highlights, samples, nearest, lens.pixel_aspect, origin, LensTile::size));
        for (int y = 0; y < LensTile::size && corner.y + y < windows.height(); ++y)
            for (int x = 0; x < LensTile::size && corner.x + x < windows.width(); ++x)
                for (std::size_t k = 0; k < ldi.channels.size(); ++k)
                    out.at(k, window.min.x + corner.x + x, window.min.y + corner.y + y) = tile.value(x, y, k);
        progress.advance();
    });
    copy_ids(ldi, out);
    return out;
}

} // namespace sparselens
