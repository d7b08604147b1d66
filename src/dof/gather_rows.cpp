#include "dof/gather_rows.h"

#include "base/parallel.h"
#include "deep/build.h"
#include "deep/channel_alpha.h"
#include "deep/unseen.h"
#include "dof/border_reach.h"
#include "dof/lens/gather_scene.h"
#include "dof/lens/lens_gather.h"
#include "dof/merge_layers.h"
#include "dof/tuning.h"
#include "lens/thin_lens.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>
#include <vector>

namespace sparselens {

namespace {

constexpr int rows_at_once = 16, cell = GatherTuning::cell_px;

// Extremes of the samples of some rows, or of all.
struct Extremes {
    double coc = 0;                                                               // pixels, without its sign
    double least_depth = std::numeric_limits<double>::infinity(), most_depth = 0; // disparity, pixels

    void add(const ThinLens &lens, double z) {
        coc = std::max(coc, std::abs(circle_of_confusion(lens, z)));
        least_depth = std::min(least_depth, disparity(lens, z));
        most_depth = std::max(most_depth, disparity(lens, z));
    }
    void add(const Extremes &other) {
        coc = std::max(coc, other.coc);
        least_depth = std::min(least_depth, other.least_depth);
        most_depth = std::max(most_depth, other.most_depth);
    }
};

// Whether light from infinity passes all samples of some pixel, by this coverage.
bool sees_infinity(const Ldi &rows, std::size_t coverage) {
    for (std::size_t pixel = 0; pixel + 1 < rows.begin.size(); ++pixel)
        if (lets_through(rows, coverage, rows.pixel(pixel))) return true;
    return false;
}

bool sees_infinity(const Ldi &rows) {
    return std::ranges::any_of(by_coverage(rows),
                               [&](const CoveredChannels &c) { return sees_infinity(rows, c.coverage); });
}

Extremes extremes_of(const Ldi &rows, const ThinLens &lens) {
    Extremes found;
    for (const auto *depths : {&rows.z, &rows.z_back}) // volumes are gathered in between (merge_layers.h)
        for (const float z : *depths)
            if (depths == &rows.z || std::isfinite(z))
                found.add(lens, double(z)); // endless ones stay in front
    for (const float image_z : rows.image_z)
        found.coc = std::max(found.coc, std::abs(circle_of_confusion(lens, double(image_z))));
    for (std::size_t i = 0; i < rows.solid.size(); ++i)
        if (const double inverse_z = 1 / double(rows.z[i]) - double(rows.solid[i]); inverse_z > 0)
            found.coc = std::max(found.coc, std::abs(circle_of_confusion(lens, 1 / inverse_z)));
    if (sees_infinity(rows)) found.add(lens, std::numeric_limits<double>::infinity());
    return found;
}

Extremes extremes_of(const PackedRows &rows, const ThinLens &lens) {
    const Imath::Box2i &data = rows.windows().data;
    Extremes all;
    std::mutex adding;
    parallel_for(std::size_t(pieces_of(rows.windows().height(), rows_at_once)), [&](std::size_t piece) {
        const int first = data.min.y + int(piece) * rows_at_once;
        const Extremes found =
            extremes_of(rows.rows(first, std::min(first + rows_at_once - 1, data.max.y)), lens);
        const std::lock_guard lock(adding);
        all.add(found);
    });
    return all;
}

// Rows, both included.
struct Band {
    int first, last;
};

// The number of rows of the picture, from its first or last one, that decide what continues beyond it
// (beyond/frame_extension.h).
int border_rows(const PictureOptions &options) {
    return GatherTuning::border_inwards * options.gather.lens.across;
}

// Returns the rows with the samples that `band` of the picture depends on, extended to whole blocks of samples and
// cells. `border`: this many rows at the top, and at the bottom, are all needed if any of them is.
Band needed(const Band &band, const RowReach &reach, const Imath::Box2i &data, int border) {
    const int first = band.first - reach.seen - data.min.y, last = band.last + reach.seen - data.min.y;
    const int whole = pieces_of(last + 1, cell) * cell;
    const int from = (first < 0 ? 0 : first / cell * cell) - reach.prepared;
    const int top = data.min.y + std::max(from, 0), bottom = data.min.y + whole - 1 + reach.prepared;
    return {bottom >= data.max.y ? std::min(top, std::max(data.max.y - border, data.min.y)) : top,
            std::min(from <= 0 ? std::max(bottom, data.min.y + border) : bottom, data.max.y)};
}

class Bands {
public:
    Bands(const PackedRows &rows, const ThinLens &lens, const Imath::Box2i &gathered,
          const PictureOptions &options)
        : rows_(rows), lens_(lens), gathered_(gathered), options_(options),
          reach_(reach_of(rows, lens, options.gather.lens.looks, options.gather.lens.across)) {
        if (const LampPaths *paths = options.gather.lens.paths)
            reach_.seen += int(std::ceil(paths->farthest()));
    }

    // The height of the bands, in rows.
    int height(const BandLimits &limits) const {
        const int least = limits.low ? lens_tile_size : 2 * (reach_.seen + reach_.prepared) + cell;
        const int tile_rows = pieces_of(gathered_.max.y - gathered_.min.y + 1, lens_tile_size);
        for (int parts = 1;; ++parts) {
            const int height = pieces_of(tile_rows, parts) * lens_tile_size,
                      lower = pieces_of(tile_rows, parts + 1) * lens_tile_size;
            if (parts >= tile_rows || lower < least || most_bytes(height) <= limits.memory) return height;
        }
    }
    // Calls visit(band) for all bands of this height, top down.
    template <typename Visit>
    void for_each(int height, const Visit &visit) const {
        for (int y = gathered_.min.y; y <= gathered_.max.y; y += height)
            visit(Band{y, std::min(y + height - 1, gathered_.max.y)});
    }
    Image gather(const Band &band, const Imath::Box2i &written, Progress &progress) const {
        const Imath::Box2i &data = rows_.windows().data;
        const Band from = needed(band, reach_, data, border_rows(options_));
        PictureOptions by = options_;
        by.gather.lens.known = gathered_;
        by.gather.lens.known->min.y = std::max(gathered_.min.y, from.first);
        by.gather.lens.known->max.y = std::min(gathered_.max.y, from.last);
        std::vector<LampPart> lamps;
        if (by.gather.lens.lamps) by.gather.lens.lamps = &lamps;
        // With the empty rows above, positions are relative to the picture's corner, and rounded as in the whole
        // picture.
        Image picture = gather_picture(with_empty_above(rows_.rows(from.first, from.last), data.min.y), lens_,
                                       {{gathered_.min.x, band.first}, {gathered_.max.x, band.last}}, written,
                                       by, progress);
        if (options_.gather.lens.lamps) add_lamps(lamps, band, *options_.gather.lens.lamps);
        return picture;
    }

private:
    // The lamps of a band alone: those of its margins are found better with the bands beside it.
    void add_lamps(std::span<const LampPart> found, const Band &band, std::vector<LampPart> &lamps) const {
        const double top = band.first == gathered_.min.y ? -HUGE_VAL : band.first,
                     bottom = band.last == gathered_.max.y ? HUGE_VAL : band.last + 1;
        std::ranges::copy_if(found, std::back_inserter(lamps), [&](const LampPart &part) {
            return double(part.at.y) >= top && double(part.at.y) < bottom;
        });
    }
    double most_bytes(int height) const {
        std::uint64_t most = 0;
        for_each(height, [&](const Band &band) {
            const Band from = needed(band, reach_, rows_.windows().data, border_rows(options_));
            most = std::max(most, rows_.samples(from.first, from.last));
        });
        return bytes_to_gather(most, rows_.channels()) + double(rows_.bytes());
    }

    const PackedRows &rows_;
    const ThinLens &lens_;
    const Imath::Box2i &gathered_;
    const PictureOptions &options_;
    RowReach reach_;
};

bool can_be_banded(const PackedRows &rows, const ThinLens &lens, const LensLooks &looks) {
    const FocusField field(looks, lens, picture_frame(rows.windows(), looks));
    return looks.magnification == 1 && field.flat();
}

Imath::Box2i common(const Imath::Box2i &window, const Band &band) {
    return {{window.min.x, std::max(window.min.y, band.first)},
            {window.max.x, std::min(window.max.y, band.last)}};
}

void copy_rows(const Image &band, Image &picture) {
    const Imath::Box2i &rows = band.windows.data;
    for (std::size_t k = 0; k < picture.channels.size(); ++k)
        std::ranges::copy(band.plane(k),
                          picture.plane(k).begin() + std::ptrdiff_t(picture.windows.index(rows.min)));
}

// The tiles of a band, without lens points.
LensTiles tiles_of(const Imath::Box2i &gathered, const Band &band) {
    const Tiles tiles({{gathered.min.x, band.first}, {gathered.max.x, band.last}}, lens_tile_size);
    return {lens_tile_size, tiles.columns(), tiles.rows(), std::vector<int>(tiles.count())};
}

void add_tiles(LensTiles &all, const LensTiles &some) {
    all.size = some.size;
    all.columns = some.columns;
    all.rows += some.rows;
    all.lens_points.insert(all.lens_points.end(), some.lens_points.begin(), some.lens_points.end());
}

} // namespace

RowReach reach_of(const PackedRows &rows, const ThinLens &lens, const LensLooks &looks, int across) {
    Extremes found = extremes_of(rows, lens);
    for (const double coc : looks.chromatic_coc) found.coc += std::abs(coc);
    const Aperture aperture(looks.aperture);
    const Imath::V2d extent = aperture.half_extent();
    const double spread = found.coc * std::max({extent.x, extent.y * lens.pixel_aspect, 1.0});
    // How far a ground continues (fillers.h), and from how far it is seen.
    const double nearer = std::max(found.most_depth - found.least_depth, 0.0);
    const double goes_on = std::max(seen_behind(nearer), 1 + found.coc);
    constexpr double most = 1 << 20; // rows: no picture has more
    constexpr int beside = 16; // rows: a block of samples, and neighbours whose links or edges they share
    // Highlights look at the adjacent cells. Sharpening looks at the noise blocks beside those, and at one more row.
    // The continuation beyond the left and the right of the frame (frame_extension.h) looks at as many rows of the
    // picture as a cell has.
    return {int(std::min(std::ceil(spread + goes_on), most)) + beside,
            (2 + across) * cell + BlockedSamples::size};
}

Image gather_rows(const PackedRows &rows, const ThinLens &lens, const Imath::Box2i &gathered,
                  const Imath::Box2i &written, const PictureOptions &options, const BandLimits &limits,
                  Progress &progress) {
    const auto all_at_once = [&] {
        const Imath::Box2i &data = rows.windows().data;
        return gather_picture(rows.rows(data.min.y, data.max.y), lens, gathered, written, options, progress);
    };
    if (!can_be_banded(rows, lens, options.gather.lens.looks)) return all_at_once();
    LensTiles all{}, some;
    PictureOptions by = options;
    by.gather.lens.chosen = &some;
    if (lens.radius > 0) {
        Ldi border = border_of(rows, gathered);
        if (merges_layers(lens, options))
            border = merge_layers(std::move(border), disparity_scale(lens.radius, lens.focal_px),
                                  options.layer_tolerance);
        by.gather.beyond = {gathered, look_beyond(border, lens, options.gather.lens.looks, gathered)};
    }
    const Bands bands(rows, lens, gathered, by);
    const int height = bands.height(limits);
    if (height > gathered.max.y - gathered.min.y) return all_at_once();
    Windows windows = rows.windows();
    windows.data = written;
    Image picture(windows, rows.channels());
    bands.for_each(height, [&](const Band &band) {
        const Imath::Box2i here = common(written, band);
        some = tiles_of(gathered, band);
        if (!here.isEmpty()) copy_rows(bands.gather(band, here, progress), picture);
        add_tiles(all, some);
    });
    if (options.gather.lens.chosen) *options.gather.lens.chosen = std::move(all);
    return picture;
}

} // namespace sparselens
