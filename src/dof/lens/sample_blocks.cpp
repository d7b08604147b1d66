#include "dof/lens/sample_blocks.h"

#include "base/error.h"
#include "deep/build.h"

#include <limits>

namespace sparselens {

namespace {

PlacedSample sample_at(const Ldi &ldi, const ThinLens &lens, const Position &at, float alpha,
                       std::uint64_t i) {
    const MergedSample place = sample_at(ldi, i);
    std::optional<float> surface_coc;
    if (is_opaque(alpha) && !ldi.image_z.empty())
        surface_coc = float(circle_of_confusion(lens, double(place.z)));
    return {float(at.column) + 0.5f + place.dx,
            float(at.row) + 0.5f + place.dy,
            float(circle_of_confusion(lens, ldi.coc_z(i))),
            float(disparity(lens, double(place.z))),
            alpha,
            std::uint32_t(i),
            surface_coc};
}

// The samples of one pixel, its background included.
void find_samples(const Ldi &ldi, const ThinLens &lens, const KnownPixels &known, const Position &at,
                  std::size_t alpha_channel, std::vector<PlacedSample> &found) {
    const std::size_t pixel = ldi.windows.index(at);
    const SampleRange samples = ldi.pixel(pixel);
    const double left = for_shares(ldi, alpha_channel, samples, [&](std::uint64_t i, double) {
        found.push_back(sample_at(ldi, lens, at, alpha_at(ldi, alpha_channel, i), i));
    });
    if (!lets_through(left) || !known.has(ldi.windows, pixel)) return;
    const auto add_background = [&](float at_x, float at_y, float coc) {
        found.push_back({at_x, at_y, coc, 0, 1, BlockedSamples::background});
    };
    constexpr double sky = std::numeric_limits<double>::infinity();
    add_background(float(at.column) + 0.5f, float(at.row) + 0.5f, float(circle_of_confusion(lens, sky)));
    if (samples.empty()) return;
    const PlacedSample last = found[found.size() - 2];
    add_background(last.x, last.y, last.coc);
}

// How many samples find_samples() finds.
SampleCounts count_samples(const Ldi &ldi, const KnownPixels &known, const Position &at,
                           std::size_t alpha_channel) {
    const std::size_t pixel = ldi.windows.index(at);
    const SampleRange samples = ldi.pixel(pixel);
    SampleCounts counts{0, std::uint32_t(samples.size())};
    const double left = for_shares(ldi, alpha_channel, samples, [&](std::uint64_t i, double) {
        counts.opaque += is_opaque(alpha_at(ldi, alpha_channel, i));
    });
    const std::uint32_t backgrounds =
        lets_through(left) && known.has(ldi.windows, pixel) ? (samples.empty() ? 1 : 2) : 0;
    return {counts.opaque + backgrounds, counts.all + backgrounds};
}

// Calls visit(position) for the pixels of a block.
template <typename Visit>
void for_each_pixel(const BlockedSamples &samples, const Windows &windows, std::size_t block,
                    const Visit &visit) {
    constexpr int size = BlockedSamples::size;
    const int left = int(block) % samples.columns * size, top = int(block) / samples.columns * size;
    for (int y = top; y < std::min(top + size, windows.height()); ++y)
        for (int x = left; x < std::min(left + size, windows.width()); ++x) visit(Position(x, y));
}

void resize(BlockedSamples &samples, std::size_t count, Also also) {
    if (also == Also::surfaces) samples.surface_coc.resize(count);
    if (also == Also::names) samples.named.resize(count);
    for (auto *array : {&samples.x, &samples.y, &samples.coc, &samples.alpha}) array->resize(count);
    samples.source.resize(count);
    samples.upper.resize(count);
}

void store(BlockedSamples &samples, std::size_t at, const PlacedSample &f) {
    samples.x[at] = f.x;
    samples.y[at] = f.y;
    samples.coc[at] = f.coc;
    if (!samples.surface_coc.empty()) samples.surface_coc[at] = f.surface_coc.value_or(f.coc);
    if (!samples.named.empty()) samples.named[at] = f.named;
    samples.alpha[at] = f.alpha;
    samples.source[at] = f.source;
    const bool is_background = f.source == BlockedSamples::background;
    samples.upper[at] = is_background ? kernels::background_upper : kernels::upper_of_depth(f.depth);
}

} // namespace

void bound(SampleBlock &block, const BlockedSamples &samples) {
    constexpr float most = std::numeric_limits<float>::max();
    block.x_min = block.y_min = block.coc_min = block.coc_least = block.depth_min = block.focus_min = most;
    block.x_max = block.y_max = block.coc_max = block.focus_max = -most;
    block.coc_shown = block.depth_max = 0;
    block.shows_opaque = block.shows_images = block.has_background = false;
    for (std::uint32_t i = block.begin; i < block.end; ++i) {
        block.x_min = std::min(block.x_min, samples.x[i]);
        block.x_max = std::max(block.x_max, samples.x[i]);
        block.y_min = std::min(block.y_min, samples.y[i]);
        block.y_max = std::max(block.y_max, samples.y[i]);
        block.coc_min = std::min(block.coc_min, samples.coc[i]);
        block.coc_max = std::max(block.coc_max, samples.coc[i]);
        block.coc_least = std::min(block.coc_least, std::abs(samples.coc[i]));
        block.depth_min = std::min(block.depth_min, samples.depth(i));
        block.depth_max = std::max(block.depth_max, samples.depth(i));
        const float focus = samples.hiding_coc()[i] + samples.depth(i);
        block.focus_min = std::min(block.focus_min, focus);
        block.focus_max = std::max(block.focus_max, focus);
        if (samples.source[i] == BlockedSamples::background) {
            block.has_background = true;
            continue;
        }
        block.coc_shown = std::max(block.coc_shown, std::abs(samples.coc[i]));
        if (samples.is_image(i)) {
            const float surface = samples.surface_coc[i];
            block.shows_images = true;
            block.coc_min = std::min(block.coc_min, surface);
            block.coc_max = std::max(block.coc_max, surface);
            block.coc_least = std::min(block.coc_least, std::abs(surface));
            block.coc_shown = std::max(block.coc_shown, std::abs(surface));
        }
        block.shows_opaque = block.shows_opaque || i < block.opaque_end;
    }
}

BlockedSamples make_blocks(const Windows &windows, const CountSamples &count, const PlaceSamples &place,
                           Also also) {
    BlockedSamples samples;
    constexpr int size = BlockedSamples::size;
    samples.columns = (windows.width() + size - 1) / size;
    samples.rows = (windows.height() + size - 1) / size;
    samples.blocks.resize(std::size_t(samples.columns) * std::size_t(samples.rows));
    parallel_for(samples.blocks.size(), [&](std::size_t b) {
        SampleBlock &block = samples.blocks[b];
        for_each_pixel(samples, windows, b, [&](const Position &at) {
            const SampleCounts counts = count(at);
            block.opaque_end += counts.opaque;
            block.end += counts.all;
        });
    });
    std::uint32_t begin = 0;
    for (SampleBlock &block : samples.blocks) {
        block.begin = begin;
        block.opaque_end += begin;
        block.end += begin;
        begin = block.end;
    }
    resize(samples, begin, also);
    parallel_for(samples.blocks.size(), [&](std::size_t b) {
        SampleBlock &block = samples.blocks[b];
        std::size_t opaque = block.begin, partial = block.opaque_end;
        std::vector<PlacedSample> placed;
        for_each_pixel(samples, windows, b, [&](const Position &at) {
            placed.clear();
            place(at, placed);
            for (const PlacedSample &f : placed) store(samples, is_opaque(f.alpha) ? opaque++ : partial++, f);
        });
        bound(block, samples);
    });
    return samples;
}

BlockedSamples make_blocks(const Windows &windows, const PlaceSamples &place, Also also) {
    const auto count = [&](const Position &at) {
        std::vector<PlacedSample> placed;
        place(at, placed);
        return SampleCounts{std::uint32_t(placed.size()), std::uint32_t(placed.size())};
    };
    return make_blocks(windows, count, place, also);
}

BlockedSamples make_blocks(const Ldi &ldi, const ThinLens &lens, const KnownPixels &known) {
    if (ldi.samples() + 2 * ldi.windows.pixels() >= BlockedSamples::background) // see count_samples()
        throw Error("the LDI has more samples than can be gathered at once (2^32)");
    const std::size_t alpha = ldi.alpha();
    const auto count = [&](const Position &at) { return count_samples(ldi, known, at, alpha); };
    const auto place = [&](const Position &at, std::vector<PlacedSample> &placed) {
        find_samples(ldi, lens, known, at, alpha, placed);
    };
    return make_blocks(ldi.windows, count, place, ldi.image_z.empty() ? Also::nothing : Also::surfaces);
}

SamplePlaces::SamplePlaces(const BlockedSamples &samples, const Ldi &ldi, int top, int bottom) {
    const auto width = std::size_t(ldi.windows.width());
    first_ = ldi.begin[std::size_t(top) * width];
    places_.resize(ldi.begin[std::size_t(bottom) * width] - first_);
    constexpr int size = BlockedSamples::size;
    const int first_block = top / size * samples.columns, end = pieces_of(bottom, size) * samples.columns;
    for (int b = first_block; b < end; ++b) {
        const SampleBlock &block = samples.blocks[std::size_t(b)];
        for (std::uint32_t i = block.begin; i < block.end; ++i)
            if (samples.source[i] != BlockedSamples::background) places_[samples.source[i] - first_] = i;
    }
}

std::uint32_t place_of(const BlockedSamples &samples, const Ldi &ldi, std::size_t pixel,
                       std::uint64_t sample) {
    const auto width = std::size_t(ldi.windows.width());
    constexpr std::size_t size = BlockedSamples::size;
    const std::size_t b = pixel / width / size * std::size_t(samples.columns) + pixel % width / size;
    const SampleBlock &block = samples.blocks[b];
    const auto from = samples.source.begin();
    return std::uint32_t(std::find(from + block.begin, from + block.end, std::uint32_t(sample)) - from);
}

} // namespace sparselens
