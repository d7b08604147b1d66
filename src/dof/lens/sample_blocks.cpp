#include "dof/lens/sample_blocks.h"

#include "base/error.h"
#include "base/parallel.h"
#include "deep/build.h"

#include <algorithm>
#include <limits>

namespace sparselens {

namespace {

PlacedSample sample_at(const Ldi &ldi, const ThinLens &lens, int x, int y, float alpha, std::uint64_t i) {
    const MergedSample place = sample_at(ldi, i);
    const double z = double(place.z);
    return {float(x) + 0.5f + place.dx,
            float(y) + 0.5f + place.dy,
            float(circle_of_confusion(lens, z)),
            float(perceptive_depth(lens, z)),
            alpha,
            std::uint32_t(i)};
}

// The samples of one pixel, its background included.
void find_samples(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &known, int x, int y,
                  std::vector<PlacedSample> &found) {
    const Imath::V2i at = ldi.windows.data.min + Imath::V2i(x, y);
    const SampleRange samples = ldi.pixel(ldi.windows.index(at.x, at.y));
    const std::size_t alpha_channel = ldi.alpha();
    double transmittance = 1;
    for (const std::uint64_t i : samples) {
        const float alpha = std::clamp(alpha_at(ldi, alpha_channel, i), 0.0f, 1.0f);
        transmittance *= 1 - double(alpha);
        found.push_back(sample_at(ldi, lens, x, y, alpha, i));
    }
    if (!lets_through(transmittance) || !known.intersects(at)) return;
    const auto add_background = [&](float at_x, float at_y, float coc) {
        found.push_back({at_x, at_y, coc, 0, 1, BlockedSamples::background});
    };
    constexpr double sky = std::numeric_limits<double>::infinity();
    add_background(float(x) + 0.5f, float(y) + 0.5f, float(circle_of_confusion(lens, sky)));
    if (samples.empty()) return;
    const PlacedSample last = found[found.size() - 2];
    add_background(last.x, last.y, last.coc);
}

std::vector<PlacedSample> block_samples(const Windows &windows, const PlaceSamples &place, int column,
                                        int row) {
    std::vector<PlacedSample> found;
    constexpr int size = BlockedSamples::size;
    const int x_end = std::min((column + 1) * size, windows.width());
    const int y_end = std::min((row + 1) * size, windows.height());
    for (int y = row * size; y < y_end; ++y)
        for (int x = column * size; x < x_end; ++x) place(x, y, found);
    std::stable_partition(found.begin(), found.end(),
                          [](const PlacedSample &f) { return is_opaque(f.alpha); });
    return found;
}

SampleBlock bounds_of(const std::vector<PlacedSample> &found) {
    constexpr float most = std::numeric_limits<float>::max();
    SampleBlock block{0, 0, std::uint32_t(found.size()), most, -most, most, -most, most, -most};
    for (const PlacedSample &f : found) {
        if (is_opaque(f.alpha)) ++block.opaque_end;
        block.x_min = std::min(block.x_min, f.x);
        block.x_max = std::max(block.x_max, f.x);
        block.y_min = std::min(block.y_min, f.y);
        block.y_max = std::max(block.y_max, f.y);
        block.coc_min = std::min(block.coc_min, f.coc);
        block.coc_max = std::max(block.coc_max, f.coc);
    }
    return block;
}

void resize(BlockedSamples &samples, std::size_t count) {
    for (auto *array : {&samples.x, &samples.y, &samples.coc, &samples.depth, &samples.alpha})
        array->resize(count);
    samples.source.resize(count);
    samples.key.resize(count);
}

void store(BlockedSamples &samples, std::size_t at, const PlacedSample &f) {
    samples.x[at] = f.x;
    samples.y[at] = f.y;
    samples.coc[at] = f.coc;
    samples.depth[at] = f.depth;
    samples.alpha[at] = f.alpha;
    samples.source[at] = f.source;
    const std::uint32_t index = std::uint32_t(at);
    samples.key[at] =
        f.source == BlockedSamples::background ? background_key(index) : depth_key(f.depth, index);
}

} // namespace

BlockedSamples make_blocks(const Windows &windows, const PlaceSamples &place) {
    BlockedSamples samples;
    constexpr int size = BlockedSamples::size;
    samples.columns = (windows.width() + size - 1) / size;
    samples.rows = (windows.height() + size - 1) / size;
    const std::size_t columns = std::size_t(samples.columns);
    samples.blocks.resize(columns * std::size_t(samples.rows));
    std::vector<std::vector<PlacedSample>> found(
        std::size_t(samples.rows)); // of a row of blocks, block after block
    parallel_for(found.size(), [&](std::size_t row) {
        for (std::size_t column = 0; column < columns; ++column) {
            const std::vector<PlacedSample> block = block_samples(windows, place, int(column), int(row));
            samples.blocks[row * columns + column] = bounds_of(block);
            found[row].insert(found[row].end(), block.begin(), block.end());
        }
    });
    std::uint32_t begin = 0;
    for (SampleBlock &block : samples.blocks) {
        block.begin += begin;
        block.opaque_end += begin;
        block.end += begin;
        begin = block.end;
    }
    resize(samples, begin);
    parallel_for(found.size(), [&](std::size_t row) {
        for (std::size_t i = 0; i < found[row].size(); ++i)
            store(samples, samples.blocks[row * columns].begin + i, found[row][i]);
        std::vector<PlacedSample>().swap(found[row]); // large pictures are short of memory
    });
    return samples;
}

BlockedSamples make_blocks(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &known) {
    if (ldi.samples() + ldi.windows.pixels() >= BlockedSamples::background)
        throw Error("the LDI has more samples than can be gathered at once (2^32)");
    return make_blocks(ldi.windows, [&](int x, int y, std::vector<PlacedSample> &placed) {
        find_samples(ldi, lens, known, x, y, placed);
    });
}

} // namespace sparselens
