#include "loading/stage_stats.h"

#include <fmt/format.h>

#include <algorithm>

namespace sparselens {

namespace {

// Cropped and masked views do not give them all.
std::size_t pixels_given(const ViewSamples &view) {
    std::size_t count = 0;
    const std::size_t alpha = view.alpha();
    for (std::size_t i = 0; i < view.windows.pixels(); ++i) count += alpha_at(view, alpha, i) > 0;
    return count;
}

} // namespace

Stats plan_stats(const Plan &plan, int views_allowed, const Windows &centre) {
    std::size_t asked = 0;
    for (const PlannedView &view : plan.views) asked += view.mask.count();
    return {{"views", plan.views.size()},
            {"views_left_out", std::size_t(views_allowed) - plan.views.size()},
            {"pixels", asked},
            {"pixels_left_out", std::size_t(views_allowed) * centre.pixels() - asked}};
}

GivenViews given_views(std::span<const PackedView> views) {
    GivenViews given{views.size(), 0, 0, views.size() * views[0].samples.windows.pixels()};
    for (const PackedView &view : views) {
        const std::size_t pixels = pixels_given(view.samples);
        given.pixels += pixels;
        given.empty += pixels == 0 ? 1 : 0;
    }
    return given;
}

Stats warp_stats(const GivenViews &given, const Ldi &ldi) {
    const auto [views, empty, pixels, all] = given;
    return {{"views", views},           {"views_empty", empty},
            {"pixels_given", pixels},   {"pixels_not_given", all - std::min(all, pixels)},
            {"samples", ldi.samples()}, {"samples_merged", pixels - std::min(pixels, ldi.samples())}};
}

Stats cluster_stats(const OpenedLdi &in, const Clustered &out) {
    return {{"samples_invisible", in.invisible},
            {"samples_read", in.ldi.samples()},
            {"samples", out.ldi.samples()},
            {"samples_merged", in.ldi.samples() - out.ldi.samples()},
            {"largest_coc_change", out.largest_error}};
}

Stats gather_stats(const LdiCache &cache, std::size_t samples, const LensTiles &tiles) {
    Stats points = Stats::object();
    std::size_t copied = 0;
    for (const auto &[number, count] : histogram(tiles)) {
        if (number == 0)
            copied = std::size_t(count);
        else
            points[fmt::to_string(number)] = count;
    }
    return {{"input_read", cache.read_now()},
            {"samples_invisible", cache.last().invisible},
            {"samples", samples},
            {"channels_left_out", cache.channels_left_out()},
            {"tiles", tiles.lens_points.size()},
            {"tiles_copied", copied},
            {"lens_points", points}};
}

} // namespace sparselens
