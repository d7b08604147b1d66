#include "warp/surfaces.h"

#include "kernels/surface.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

constexpr std::uint32_t none = ~0u;

// As std::stable_sort, which allocates memory however few there are; most pixels have no more samples than views.
template <typename Before>
void sort_stably(std::span<ViewSample> samples, const Before &before) {
    constexpr std::size_t few = 16;
    if (samples.size() > few) return std::stable_sort(samples.begin(), samples.end(), before);
    for (std::size_t i = 1; i < samples.size(); ++i) {
        const ViewSample s = samples[i];
        std::size_t at = i;
        for (; at > 0 && before(s, samples[at - 1]); --at) samples[at] = samples[at - 1];
        samples[at] = s;
    }
}

bool one_surface(const ViewSample &a, const ViewSample &b, double tolerance) {
    return kernels::is_one_surface(double(a.inverse_z), double(b.inverse_z), tolerance);
}

// The samples of a pixel, front to back, that belong to it.
std::span<ViewSample> behind_centre(const ReprojectedViews &views, double tolerance,
                                    std::span<ViewSample> samples) {
    const auto centre =
        std::find_if(samples.begin(), samples.end(), [](const auto &s) { return s.view == 0; });
    if (centre == samples.end()) {
        const Imath::V2i pixel(samples[0].x, samples[0].y);
        return views.samples(0).windows.data.intersects(pixel) ? samples.first(0) : samples;
    }
    const auto first = std::find_if(samples.begin(), centre,
                                    [&](const auto &s) { return one_surface(s, *centre, tolerance); });
    return samples.subspan(std::size_t(first - samples.begin()));
}

// Numbers all samples of the anchor's surface that belong to none yet.
Surface claim(double tolerance, const ViewSample &anchor, std::uint32_t number,
              std::span<ViewSample> samples) {
    double sum = 0, total = 0;
    for (ViewSample &s : samples) {
        if (s.surface != none || !one_surface(s, anchor, tolerance)) continue;
        s.surface = number;
        sum += s.weight * s.inverse_z;
        total += s.weight;
    }
    return {{}, sum / total};
}

// Brings the samples of each surface together, the centre's first.
void group(std::span<ViewSample> samples, std::span<Surface> surfaces) {
    sort_stably(samples, [](const auto &a, const auto &b) {
        return a.surface != b.surface ? a.surface < b.surface : a.view < b.view;
    });
    for (std::size_t first = 0, last = 0; first < samples.size(); first = last) {
        while (last < samples.size() && samples[last].surface == samples[first].surface) ++last;
        surfaces[samples[first].surface].samples = samples.subspan(first, last - first);
    }
}

// Appends those of one pixel.
void find_in_pixel(const ReprojectedViews &views, double tolerance, std::span<ViewSample> samples,
                   std::vector<Surface> &surfaces) {
    if (samples.empty()) return;
    sort_stably(samples, [](const auto &a, const auto &b) { return a.inverse_z > b.inverse_z; });
    samples = behind_centre(views, tolerance, samples);
    for (ViewSample &s : samples) s.surface = none;
    const std::size_t before = surfaces.size();
    for (const bool centre : {true, false}) // the centre's samples say where surfaces are, before any other
        for (const ViewSample &anchor : samples)
            if (anchor.surface == none && (anchor.view == 0) == centre)
                surfaces.push_back(
                    claim(tolerance, anchor, std::uint32_t(surfaces.size() - before), samples));
    const std::span<Surface> here = std::span(surfaces).subspan(before);
    group(samples, here);
    std::ranges::sort(here, [](const auto &a, const auto &b) { return a.inverse_z > b.inverse_z; });
}

} // namespace

Surfaces find_surfaces(const ReprojectedViews &views, double tolerance, ReprojectedRows &rows) {
    Surfaces surfaces;
    surfaces.begin.push_back(0);
    for (std::size_t pixel = 0; pixel < rows.pixels(); ++pixel) {
        find_in_pixel(views, tolerance, rows.pixel(pixel), surfaces.list);
        surfaces.begin.push_back(surfaces.list.size());
    }
    return surfaces;
}

} // namespace sparselens
