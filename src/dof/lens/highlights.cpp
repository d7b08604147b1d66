#include "dof/lens/highlights.h"

#include "base/parallel.h"
#include "lens/psf.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

constexpr int neighbourhood = 4;      // blocks wide and high
constexpr std::size_t brightest = 32; // one sample in so many may be a highlight
constexpr float stands_out = 4;       // times what is around
constexpr float smallest_coc = 2;     // pixels

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
    if (levels.empty()) return found;
    const auto limit = levels.begin() + std::ptrdiff_t(levels.size() - 1 - levels.size() / brightest);
    std::vector<float> sorted(levels);
    std::nth_element(sorted.begin(), sorted.begin() + (limit - levels.begin()), sorted.end());
    const float level = sorted[std::size_t(limit - levels.begin())];
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

NearestLensPoint::NearestLensPoint(std::span<const LensSample> lens) : scale_x_(0), scale_y_(0) {
    for (const LensSample &p : lens) {
        scale_x_ = std::max(scale_x_, std::abs(p.x));
        scale_y_ = std::max(scale_y_, std::abs(p.y));
    }
    // A set of one point, the lens's middle, has no width: any place is nearest to it.
    scale_x_ = scale_x_ > 0 ? scale_x_ : 1;
    scale_y_ = scale_y_ > 0 ? scale_y_ : 1;
    table_.resize(std::size_t(cells) * cells);
    parallel_for(table_.size(), [&](std::size_t i) {
        const float x = ((float(i % cells) + 0.5f) * 2 / cells - 1) * scale_x_;
        const float y = ((float(i / cells) + 0.5f) * 2 / cells - 1) * scale_y_;
        float least = INFINITY;
        for (std::uint32_t k = 0; k < lens.size(); ++k) {
            const float dx = lens[k].x - x, dy = lens[k].y - y, distance = dx * dx + dy * dy;
            if (distance < least) {
                least = distance;
                table_[i] = k;
            }
        }
    });
}

std::uint32_t NearestLensPoint::operator()(float x, float y) const {
    const auto cell = [](float v, float scale) {
        return std::size_t(std::clamp((v / scale + 1) * 0.5f * cells, 0.0f, float(cells - 1)));
    };
    return table_[cell(y, scale_y_) * cells + cell(x, scale_x_)];
}

std::vector<HighlightPixel> highlight_pixels(const Highlights &highlights, const BlockedSamples &samples,
                                             const NearestLensPoint &nearest, double pixel_aspect,
                                             const Imath::V2i &origin, int size) {
    std::vector<HighlightPixel> pixels;
    std::vector<double> weights(std::size_t(size) + 1);
    for (std::uint32_t h = 0; h < highlights.sample.size(); ++h) {
        const std::uint32_t s = highlights.sample[h];
        const double radius = std::abs(double(samples.coc[s])),
                     reach = radius * std::max(1.0, pixel_aspect) + 1;
        const Imath::V2d centre(double(samples.x[s]), double(samples.y[s]));
        if (centre.x + reach < origin.x || centre.x - reach > origin.x + size ||
            centre.y + reach < origin.y || centre.y - reach > origin.y + size)
            continue;
        const PsfRows rows({centre, radius, pixel_aspect}, {origin, origin + Imath::V2i(size - 1)});
        for (int y = rows.begin_row(); y < rows.end_row(); ++y) {
            const PsfRows::Span span = rows.row(y, weights.data());
            for (int x = span.begin; x < span.end; ++x) {
                const float dx = float(x) + 0.5f - samples.x[s], dy = float(y) + 0.5f - samples.y[s];
                pixels.push_back({nearest(dx / samples.coc[s], dy / samples.coc[s]),
                                  std::uint16_t(x - origin.x), std::uint16_t(y - origin.y), h,
                                  float(weights[std::size_t(x - origin.x)])});
            }
        }
    }
    std::stable_sort(pixels.begin(), pixels.end(),
                     [](const auto &a, const auto &b) { return a.lens < b.lens; });
    return pixels;
}

} // namespace sparselens
