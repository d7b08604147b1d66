#include "ldi/surfaces.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

constexpr std::uint32_t none = ~0u;

bool one_surface(const PlacedSample &a, const PlacedSample &b, double tolerance) {
    return std::abs(double(a.inverse_z) - double(b.inverse_z)) < tolerance || a.inverse_z == b.inverse_z;
}

// Of the samples of a pixel, front to back, those that belong to it.
std::span<PlacedSample> behind_centre(const PlacedViews &views, double tolerance,
                                      std::span<PlacedSample> samples) {
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

// All samples of the anchor's surface that belong to none yet.
void gather_surface(const PlacedViews &views, double tolerance, const PlacedSample &anchor,
                    std::uint32_t number, std::span<PlacedSample> samples, Surface &surface) {
    surface.samples.clear();
    double sum = 0, total = 0;
    for (PlacedSample &s : samples) {
        if (s.surface != none || !one_surface(s, anchor, tolerance)) continue;
        s.surface = number;
        surface.samples.push_back(s);
        sum += views.weight(s) * double(s.inverse_z);
        total += views.weight(s);
    }
    surface.inverse_z = sum / total;
    std::stable_sort(surface.samples.begin(), surface.samples.end(),
                     [](const auto &a, const auto &b) { return a.view < b.view; });
}

} // namespace

void find_surfaces(const PlacedViews &views, double tolerance, std::span<PlacedSample> samples,
                   Surfaces &surfaces) {
    surfaces.count = 0;
    if (samples.empty()) return;
    std::stable_sort(samples.begin(), samples.end(),
                     [](const auto &a, const auto &b) { return a.inverse_z > b.inverse_z; });
    samples = behind_centre(views, tolerance, samples);
    for (PlacedSample &s : samples) s.surface = none;
    for (const bool centre : {true, false}) // the centre's samples say where surfaces are, before any other
        for (const PlacedSample &anchor : samples) {
            if (anchor.surface != none || (anchor.view == 0) != centre) continue;
            const std::size_t number = surfaces.count++;
            if (surfaces.list.size() < surfaces.count) surfaces.list.emplace_back();
            gather_surface(views, tolerance, anchor, std::uint32_t(number), samples, surfaces.list[number]);
        }
    std::sort(surfaces.list.begin(), surfaces.list.begin() + std::ptrdiff_t(surfaces.count),
              [](const auto &a, const auto &b) { return a.inverse_z > b.inverse_z; });
}

} // namespace sparselens
