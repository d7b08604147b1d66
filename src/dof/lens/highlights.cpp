#include "dof/lens/highlights.h"

#include "base/parallel.h"
#include "lens/lamp_spread.h"
#include "lens/psf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

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

namespace {

// A highlight at work in one tile.
struct Spreading {
    std::uint32_t highlight, sample;
    Lamp lamp;
    Imath::V2i origin;
};

class PixelList {
public:
    PixelList(const BlockedSamples &samples, const NearestLensPoint &nearest)
        : samples_(samples), nearest_(nearest) {}

    void add(const Spreading &from, int x, int y, ColourSet of, double weight) {
        const std::uint32_t s = from.sample;
        const float dx = float(x) + 0.5f - samples_.x[s], dy = float(y) + 0.5f - samples_.y[s];
        pixels.push_back({nearest_(dx / samples_.coc[s], dy / samples_.coc[s]),
                          std::uint8_t(x - from.origin.x), std::uint8_t(y - from.origin.y), of,
                          from.highlight, float(weight)});
    }

    std::vector<HighlightPixel> pixels;

private:
    const BlockedSamples &samples_;
    const NearestLensPoint &nearest_;
};

void add_disc(PixelList &list, const Spreading &from, const Aperture &aperture, int size) {
    const double squeeze = aperture.shape().squeeze;
    const Psf psf{from.lamp.centre, std::abs(from.lamp.coc) / squeeze, from.lamp.pixel_aspect * squeeze};
    const PsfRows rows(psf, {from.origin, from.origin + Imath::V2i(size - 1)});
    std::array<double, PsfRows::max_size + 1> weights;
    for (int y = rows.begin_row(); y < rows.end_row(); ++y) {
        const PsfRows::Span span = rows.row(y, weights.data());
        for (int x = span.begin; x < span.end; ++x)
            list.add(from, x, y, all_colours, weights[std::size_t(x - from.origin.x)]);
    }
}

// What a cat-eye leaves at the pixels of a tile, computed when it is first asked for.
class TileShares {
public:
    TileShares(const HighlightShape &shape, const Imath::Box2i &tile)
        : shape_(shape), tile_(tile.min + shape.corner, tile.max + shape.corner),
          width_(std::size_t(tile.max.x - tile.min.x) + 1) {}

    double at(bool behind, int x, int y) { // pixels of the tile, from its corner
        std::vector<double> &shares = shares_[behind];
        if (shares.empty()) shares = shape_.cat_eye.shares(behind, tile_);
        return shares[std::size_t(y) * width_ + std::size_t(x)];
    }

private:
    const HighlightShape &shape_;
    Imath::Box2i tile_;
    std::size_t width_;
    std::array<std::vector<double>, 2> shares_;
};

constexpr double least_share = 1e-4; // what a cat-eye leaves less of is dark

void add_shape(PixelList &list, const Spreading &from, const HighlightShape &shape, TileShares &shares,
               int size) {
    const bool cut = shape.cat_eye.cuts();
    const Imath::V2i corner = shape.corner + from.origin;
    Lamp lamp = from.lamp;
    lamp.centre += Imath::V2d(shape.corner);
    const LampSpread spread = spread_lamp(shape.aperture, lamp, {corner, corner + Imath::V2i(size - 1)},
                                          cut ? &shape.cat_eye : nullptr);
    std::size_t i = 0;
    for (int y = spread.box.min.y; !spread.box.isEmpty() && y <= spread.box.max.y; ++y)
        for (int x = spread.box.min.x; x <= spread.box.max.x; ++x, ++i) {
            if (spread.weights[i] <= 0) continue;
            const double left =
                cut && !shape.cat_eye.darkens() ? shares.at(lamp.coc > 0, x - corner.x, y - corner.y) : 1;
            if (left < least_share) continue;
            const int column = x - shape.corner.x, row = y - shape.corner.y;
            if (!spread.coloured) {
                list.add(from, column, row, all_colours, spread.weights[i] / left);
                continue;
            }
            list.add(from, column, row, red, spread.colours[i][0] / left);
            list.add(from, column, row, green, spread.colours[i][1] / left);
            list.add(from, column, row, blue, spread.colours[i][2] / left);
            list.add(from, column, row, ColourSet(coverage | data), spread.weights[i] / left);
        }
}

} // namespace

std::vector<HighlightPixel> highlight_pixels(const Highlights &highlights, const BlockedSamples &samples,
                                             const NearestLensPoint &nearest, const HighlightShape &shape,
                                             double pixel_aspect, const Imath::V2i &origin, int size) {
    PixelList list(samples, nearest);
    TileShares shares(shape, {origin, origin + Imath::V2i(size - 1)});
    const Aperture &aperture = shape.aperture;
    const bool disc = aperture.disc() && !shape.cat_eye.cuts();
    const Imath::V2d extent = aperture.half_extent();
    const double largest = std::max(extent.x, extent.y * pixel_aspect);
    for (std::uint32_t h = 0; h < highlights.sample.size(); ++h) {
        const std::uint32_t s = highlights.sample[h];
        const Lamp lamp{{double(samples.x[s]), double(samples.y[s])}, double(samples.coc[s]), pixel_aspect};
        const double reach = std::abs(lamp.coc) * largest + 1;
        const Imath::V2d centre = lamp.centre;
        if (centre.x + reach < origin.x || centre.x - reach > origin.x + size ||
            centre.y + reach < origin.y || centre.y - reach > origin.y + size)
            continue;
        const Spreading from{h, s, lamp, origin};
        disc ? add_disc(list, from, aperture, size) : add_shape(list, from, shape, shares, size);
    }
    std::stable_sort(list.pixels.begin(), list.pixels.end(),
                     [](const auto &a, const auto &b) { return a.lens < b.lens; });
    return std::move(list.pixels);
}

} // namespace sparselens
