#include "deep/proxy.h"

#include "base/subpixels.h"
#include "deep/build.h"
#include "deep/channel_alpha.h"
#include "deep/tidy.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sparselens {

namespace {

// A small pixel at an edge is covered in part, which takes a channel to say so.
Ldi with_coverage(Ldi ldi) {
    ldi.channels.push_back({"A", PixelType::half});
    ldi.values.emplace_back(ldi.samples(), 1.0f);
    return ldi;
}

// A sample of a large pixel, and what of it the flattened picture shows.
struct Seen {
    std::uint64_t index;
    double z, optical;
    double shown; // the transmittance in front of it
    double x, y;  // place, in small pixels from the middle of the small one
};

std::vector<Seen> samples_in(const Ldi &ldi, std::size_t alpha, const Imath::V2i &small, int factor) {
    std::vector<Seen> seen;
    for (int y = small.y * factor; y < (small.y + 1) * factor; ++y)
        for (int x = small.x * factor; x < (small.x + 1) * factor; ++x) {
            if (!ldi.windows.data.intersects(Imath::V2i(x, y))) continue;
            const std::size_t pixel = ldi.windows.index(x, y);
            double shown = 1;
            for (const std::uint64_t i : ldi.pixel(pixel)) {
                const MergedSample s = sample_at(ldi, i);
                seen.push_back({i, s.z, s.optical, shown, (x + 0.5 + s.dx) / factor - (small.x + 0.5),
                                (y + 0.5 + s.dy) / factor - (small.y + 0.5)});
                shown *= 1 - double(alpha_at(ldi, alpha, i));
            }
        }
    std::ranges::stable_sort(seen, {}, &Seen::z);
    return seen;
}

// Whether both belong to one surface and show images of about one depth. The limits are ratios, not pixels, as the lens is
// not known here.
bool alike(const Seen &first, const Seen &s) {
    constexpr double surface_depth_ratio = 1.01, largest_image_difference = 0.05;
    const bool one_image =
        s.optical == first.optical || std::abs(first.optical / s.optical - 1) <= largest_image_difference;
    return s.z <= surface_depth_ratio * first.z && one_image;
}

float offset(double sum, std::size_t count) { return float(std::clamp(sum / double(count), -0.5, 0.5)); }

// Appends the surfaces of one small pixel.
void append_surfaces(const Ldi &ldi, std::size_t alpha, const std::vector<Seen> &seen, double pixels,
                     Ldi &out) {
    // Of the light; less is what rounding leaves behind surfaces that hide everything.
    constexpr double nothing_left = 1e-4;
    double left = 1; // of the light, behind the surfaces so far
    std::vector<Term> terms;
    for (std::size_t begin = 0, end = 0; begin < seen.size(); begin = end) {
        MergedSample surface = sample_at(ldi, seen[begin].index);
        double x = 0, y = 0, shown = 0;
        terms.clear();
        for (; end < seen.size() && alike(seen[begin], seen[end]); ++end) {
            const Seen &s = seen[end];
            x += s.x, y += s.y;
            shown += s.shown * alpha_at(ldi, alpha, s.index) / pixels;
            terms.push_back({s.index, (left > nothing_left ? s.shown / left : 1) / pixels});
        }
        surface.dx = offset(x, end - begin), surface.dy = offset(y, end - begin);
        surface.z_back = surface.z;
        surface.terms = terms;
        surface.solid = solid_of(ldi, alpha, terms);
        append(out, ldi, surface);
        if (ldi.dx.empty()) out.dx.push_back(surface.dx), out.dy.push_back(surface.dy);
        out.values[alpha].back() = std::min(out.values[alpha].back(), 1.0f); // but for rounding it is
        left = std::max(0.0, left - shown);
    }
}

} // namespace

Ldi proxy(const Ldi &ldi, int factor) {
    if (factor == 1) return ldi;
    if (ldi.alpha() == npos) return proxy(with_coverage(ldi), factor);
    Ldi like = empty_like(ldi);
    Windows &windows = like.windows;
    windows.display = reduced(windows.display, factor);
    windows.data = reduced(windows.data, factor);
    const double pixels = double(factor) * factor;
    Ldi out = with_each_coverage(ldi, [&](std::size_t coverage) {
        return build_by_pixels(like, [&](std::size_t pixel, Ldi &row) {
            append_surfaces(ldi, coverage, samples_in(ldi, coverage, windows.pixel(pixel), factor), pixels,
                            row);
        });
    });
    return tidy(std::move(out));
}

Ldi enlarged(const Ldi &ldi, int factor) {
    Ldi like = empty_like(ldi);
    like.windows.display = subpixels_in(like.windows.display, factor);
    like.windows.data = subpixels_in(like.windows.data, factor);
    Ldi out = build_by_pixels(like, [&](std::size_t pixel, Ldi &row) {
        const Imath::V2i at = like.windows.pixel(pixel);
        const Imath::V2i from = reduced({at, at}, factor).min;
        for (const std::uint64_t i : ldi.pixel(ldi.windows.index(from.x, from.y))) append(row, ldi, i);
    });
    out.dx.clear(), out.dy.clear();
    return out;
}

} // namespace sparselens
