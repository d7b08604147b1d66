#include "warp/reprojected_views.h"

#include "base/error.h"
#include "base/light.h"
#include "base/parallel.h"
#include "kernels/surface.h"
#include "lens/thin_lens.h"
#include "warp/images/matched_view.h"
#include "warp/lamps/lamp_depths.h"
#include "warp/silhouettes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace sparselens {

namespace {

// Calls visit(position in the centre view, 1 / z) for each part that covers only some of its pixel.
template <typename Visit>
void for_each_partial(const PlacedView &view, const Visit &visit) {
    const ViewSamples &samples = *view.samples;
    const std::size_t alpha = samples.alpha();
    for (std::size_t p = 0; p < samples.windows.pixels(); ++p)
        for (const std::uint64_t i : samples.pixel(p)) {
            const float covers = alpha_at(samples, alpha, i);
            if (!samples.is_part(i) || !(covers > 0) || is_opaque(covers)) continue;
            const Imath::V2d middle = Imath::V2d(samples.windows.pixel(p)) + Imath::V2d(0.5);
            const double inverse_z = 1 / double(samples.z(i));
            visit(view.mapping->at_infinity(middle) + view.mapping->parallax(middle) * inverse_z, inverse_z);
        }
}

// Marks the pixels under a square of one pixel around a position, at most four, unless they show something nearer.
void mark(const ViewSamples &view, const Imath::V2d &place, double inverse_z, double tolerance,
          std::vector<bool> &mixed) {
    if (!(std::abs(place.x) < 1e9 && std::abs(place.y) < 1e9)) return;
    const int x = int(std::floor(place.x - 0.5)), y = int(std::floor(place.y - 0.5));
    for (int v = y; v <= y + 1; ++v)
        for (int u = x; u <= x + 1; ++u) {
            if (!view.windows.data.intersects(Imath::V2i(u, v))) continue;
            const std::size_t pixel = view.windows.index(Imath::V2i(u, v));
            if (inverse_z > 1 / double(view.z(pixel)) - tolerance) mixed[pixel] = true;
        }
}

// Finds the pixels of flat views that mix several surfaces, as deep views tell: a part of a deep view that covers only
// some of its pixel also covers only some of the pixels of a flat view that it falls on, if nothing in the flat view is
// nearer. The colour of such a pixel is not its surface's alone: it shows an edge, a veil or fog. Returns
// [view][pixel]; empty for deep views. Depths whose inverses differ by less than `tolerance` are one surface.
std::vector<std::vector<bool>> find_mixed_pixels(std::span<const PlacedView> views, double tolerance) {
    std::vector<std::vector<bool>> mixed(views.size());
    parallel_for(views.size(), [&](std::size_t v) {
        const PlacedView &flat = views[v];
        if (flat.samples->deep()) return;
        mixed[v].resize(flat.samples->windows.pixels());
        for (const PlacedView &deep : views)
            if (deep.samples->deep())
                for_each_partial(deep, [&](const Imath::V2d &place, double inverse_z) {
                    mark(*flat.samples, flat.mapping->in_view(place, inverse_z), inverse_z, tolerance,
                         mixed[v]);
                });
    });
    return mixed;
}

// Orders views by their cameras, and by what they show if their cameras are the same, so that the order in which they
// are given does not matter.
bool canonically_before(const PackedView &a, const PackedView &b) {
    const auto camera = [](const PackedView &v) {
        const Framing &f = v.framing;
        return std::array{v.position.x, v.position.y,        f.forward,
                          f.zoom,       f.principal_point.x, f.principal_point.y};
    };
    return camera(a) != camera(b) ? camera(a) < camera(b) : a.samples < b.samples;
}

// Repairs the depths of lamps in flat views. Deep views need no repair, because their parts mix nothing.
std::vector<PartlyHiddenLamps> repair_lamps(std::vector<ViewSamples> &views,
                                            const std::vector<ViewMapping> &mappings, double tolerance) {
    std::vector<std::size_t> flat;
    std::vector<ViewSamples> samples;
    std::vector<ViewMapping> mappings_of_flat;
    for (std::size_t v = 0; v < views.size(); ++v)
        if (!views[v].deep()) {
            flat.push_back(v);
            samples.push_back(std::move(views[v]));
            mappings_of_flat.push_back(mappings[v]);
        }
    std::vector<PartlyHiddenLamps> found, crossed(views.size());
    if (flat.size() > 1) found = repair_lamp_depths(samples, mappings_of_flat, tolerance);
    for (std::size_t n = 0; n < flat.size(); ++n) {
        views[flat[n]] = std::move(samples[n]);
        if (!found.empty()) crossed[flat[n]] = std::move(found[n]);
    }
    return crossed;
}

} // namespace

void check_views(std::span<const PackedView> views) {
    const PackedView &centre = views[0];
    for (const PackedView &view : views) {
        if (view.samples.windows.display != centre.samples.windows.display)
            throw Error(fmt::format("{}: its display window differs from that of the centre view ({})",
                                    view.name, centre.name));
        for (const Channel &channel : centre.samples.channels)
            channel_of(view.name, view.samples.channels, channel);
    }
}

ReprojectedViews::ReprojectedViews(std::vector<PackedView> views, double focal_px, double scale,
                                   double jump) {
    check_views(views);
    std::sort(views.begin() + 1, views.end(), canonically_before);
    const Windows windows = views[0].samples.windows; // the samples are taken one by one
    const std::vector<Channel> channels = views[0].samples.channels;
    const Imath::V2d centre = views[0].framing.principal_point;
    std::vector<ViewMapping> mappings;
    std::vector<ViewSamples> samples;
    for (PackedView &view : views) {
        mappings.emplace_back(view.position, focal_px, windows, view.framing, centre);
        samples.push_back(std::move(view.samples));
        samples.back().keep_channels(channels);
    }
    const bool separate = jump > 0 && scale > 0;
    std::vector<PartlyHiddenLamps> crossed(samples.size());
    if (separate) crossed = repair_lamps(samples, mappings, inverse_depth_step(scale, jump));
    sources_.resize(samples.size());
    // One after the other, each by all threads, which takes less memory.
    for (std::size_t v = 0; v < samples.size(); ++v) {
        some_are_deep_ = some_are_deep_ || samples[v].deep();
        const BackgroundFromViews others(samples, mappings, v, scale);
        if (separate && !samples[v].deep())
            separate_silhouettes(samples[v], scale, jump, crossed[v], samples.size() > 1 ? &others : nullptr);
    }
    // Only now, because BackgroundFromViews reads all views.
    for (std::size_t v = 0; v < samples.size(); ++v)
        sources_[v] = std::make_unique<Source>(std::move(samples[v]), mappings[v]);
    if (!some_are_deep_) return;
    std::vector<PlacedView> placed;
    for (const auto &source : sources_) placed.push_back({&source->samples, &source->reprojection.mapping()});
    if (scale > 0) mixed_ = find_mixed_pixels(placed, inverse_depth_step(scale, one_surface_px));
    mixed_.resize(size());
}

ReprojectedRows ReprojectedViews::place(const Imath::Box2i &data, int first_row, int last_row,
                                        ReprojectedRows rows) const {
    const Grid grid(Imath::Box2i({data.min.x, first_row}, {data.max.x, last_row}));
    const auto pixel_of = [&](const ReprojectedSample &s) { return grid.index(Imath::V2i(s.x, s.y)); };
    const auto outside = [&](const ReprojectedSample &s) { return s.x < data.min.x || s.x > data.max.x; };
    rows.first_row = first_row;
    rows.begin.assign(grid.size() + 1, 0);
    rows.by_view.clear();
    std::vector<std::size_t> end_of_view;
    for (std::size_t v = 0; v < size(); ++v) {
        const auto before = std::ptrdiff_t(rows.by_view.size());
        reprojection(v).append_rows(first_row, last_row, rows.by_view);
        rows.by_view.erase(std::remove_if(rows.by_view.begin() + before, rows.by_view.end(), outside),
                           rows.by_view.end());
        end_of_view.push_back(rows.by_view.size());
    }
    for (const ReprojectedSample &s : rows.by_view) ++rows.begin[pixel_of(s) + 1];
    std::partial_sum(rows.begin.begin(), rows.begin.end(), rows.begin.begin());
    rows.samples.resize(rows.begin.back());
    std::vector<std::size_t> next(rows.begin.begin(), rows.begin.end() - 1);
    std::size_t i = 0;
    for (std::uint32_t v = 0; v < size(); ++v)
        for (; i < end_of_view[v]; ++i) {
            const ReprojectedSample &s = rows.by_view[i];
            rows.samples[next[pixel_of(s)]++] = {
                s, v, 0, samples(v).weight(s.source) * kernels::nearness(double(s.dx), double(s.dy))};
        }
    return rows;
}

Reprojection::Reprojection(const ViewSamples &view, const ViewMapping &mapping)
    : view_(view), mapping_(mapping), reach_(std::size_t(view.windows.height())) {
    const Imath::Box2i &data = view.windows.data;
    parallel_for(reach_.size(), [&](std::size_t row) {
        double nearest = std::numeric_limits<double>::infinity();
        const int row_y = data.min.y + int(row);
        for (int x = data.min.x; x <= data.max.x; ++x)
            for (const std::uint64_t i : view_.pixel(view_.windows.index(Imath::V2i(x, row_y))))
                nearest = std::min(nearest, double(view_.z(i)));
        // Positions are linear in the column and in 1 / z, so the extremes lie at the ends of both.
        const double y = row_y + 0.5;
        for (const double x : {data.min.x + 0.5, data.max.x + 0.5})
            for (const double inverse_z : {0.0, 1 / nearest})
                reach_[row].extendBy(mapping_.at_infinity({x, y}) + mapping_.parallax({x, y}) * inverse_z);
    });
}

Imath::Box2i Reprojection::reach() const {
    constexpr double far_off = 1 << 28; // keeps the box's corners integers
    Imath::Box2d box;
    for (const Imath::Box2d &row : reach_) box.extendBy(row);
    const auto whole = [&](double v) { return int(std::floor(std::clamp(v, -far_off, far_off))); };
    return {{whole(box.min.x), whole(box.min.y)}, {whole(box.max.x), whole(box.max.y)}};
}

void Reprojection::append_rows(int first_row, int last_row, std::vector<ReprojectedSample> &out) const {
    const Imath::Box2i &data = view_.windows.data;
    const Grid grid = view_.windows.grid();
    for (std::size_t row = 0; row < reach_.size(); ++row) {
        if (!may_reach(row, first_row, last_row)) continue;
        const int from_y = data.min.y + int(row);
        for (int from_x = data.min.x; from_x <= data.max.x; ++from_x) {
            const std::size_t pixel = grid.index(Imath::V2i(from_x, from_y));
            if (view_.pixel(pixel).empty()) continue;
            const Imath::V2d q(from_x + 0.5, from_y + 0.5);
            const Imath::V2d far = mapping_.at_infinity(q), parallax = mapping_.parallax(q);
            for (const std::uint64_t i : view_.pixel(pixel)) {
                const double inverse_z = 1 / double(view_.z(i));
                const double y = far.y + parallax.y * inverse_z;
                // true for most samples of views from above or below
                if (!(y >= first_row && y < last_row + 1)) continue;
                const double x = far.x + parallax.x * inverse_z, cell_x = std::floor(x),
                             cell_y = std::floor(y);
                if (!(std::abs(cell_x) < 1e9)) continue; // so near that it lies outside of any picture
                out.push_back({int(cell_x), int(cell_y), float(x - cell_x - 0.5), float(y - cell_y - 0.5),
                               float(inverse_z), std::uint32_t(i)});
            }
        }
    }
}

} // namespace sparselens
