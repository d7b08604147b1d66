#include "deep/proxy.h"

#include "base/subpixels.h"
#include "deep/build.h"
#include "deep/channel_alpha.h"
#include "deep/tidy.h"
#include "lens/psf.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace sparselens {

namespace {

// Adds a channel A if it is missing, because a small pixel at an edge is covered in part.
Ldi with_coverage(Ldi ldi) {
    ldi.channels.push_back({"A", PixelType::half});
    ldi.values.emplace_back(ldi.samples(), 1.0f);
    return ldi;
}

// A sample of a large pixel, and how much of it the flattened picture shows.
struct Seen {
    std::uint64_t index;
    double z, image_z; // of joined samples, the means
    double shown;      // the transmittance in front of it
    double x, y;       // place, in small pixels from the middle of the small one
};

// Gives joined samples the means of their surface.
void take_means(std::span<const std::uint32_t> joined, std::vector<Seen> &seen) {
    struct Surface {
        std::uint32_t first;
        double inverse_z = 0, inverse_image_z = 0;
        int samples = 0;
    };
    thread_local std::vector<Surface> surfaces; // short, because most samples are alone and not listed here
    surfaces.clear();
    const auto surface_of = [&](const Seen &s) {
        return std::ranges::find(surfaces, joined[s.index], &Surface::first);
    };
    for (const Seen &s : seen)
        if (joined[s.index] != s.index && surface_of(s) == surfaces.end())
            surfaces.push_back({joined[s.index]});
    if (surfaces.empty()) return;
    for (const Seen &s : seen)
        if (const auto surface = surface_of(s); surface != surfaces.end()) {
            surface->inverse_z += 1 / s.z;
            surface->inverse_image_z += 1 / s.image_z;
            ++surface->samples;
        }
    for (Seen &s : seen)
        if (const auto surface = surface_of(s); surface != surfaces.end()) {
            s.z = surface->samples / surface->inverse_z;
            s.image_z = surface->samples / surface->inverse_image_z;
        }
}

// A cell that is solid in part counts as solid. Otherwise the light of lamps would pass by the edges of what hides
// them, through gaps as wide as a cell.
float most_solid_of(const Ldi &ldi, std::span<const Term> terms) {
    float most = 0;
    for (const Term &term : terms)
        if (!ldi.solid.empty()) most = std::max(most, ldi.solid[term.index]);
    return most;
}

// Sets `seen` to the samples of a small pixel, front to back.
void find_samples(const Ldi &ldi, std::size_t alpha, const Imath::V2i &small, int factor,
                  std::span<const std::uint32_t> joined, std::vector<Seen> &seen) {
    seen.clear();
    for (int y = small.y * factor; y < (small.y + 1) * factor; ++y)
        for (int x = small.x * factor; x < (small.x + 1) * factor; ++x) {
            if (!ldi.windows.data.intersects(Imath::V2i(x, y))) continue;
            for_shares(ldi, alpha, ldi.pixel(ldi.windows.index(Imath::V2i(x, y))),
                       [&](std::uint64_t i, double shown) {
                           const MergedSample s = sample_at(ldi, i);
                           seen.push_back({i, s.z, s.image_z, shown,
                                           (x + 0.5 + s.dx) / factor - (small.x + 0.5),
                                           (y + 0.5 + s.dy) / factor - (small.y + 0.5)});
                       });
        }
    if (!joined.empty()) take_means(joined, seen);
    std::ranges::sort(seen, {}, [](const Seen &s) { return std::pair(s.z, s.index); });
}

// Whether both belong to one surface and show images of about the same depth: by `by.tolerance`, or by ratios if no
// lens is known.
bool alike(const Seen &first, const Seen &s, const ProxyFor &by) {
    if (by.scale > 0)
        return by.scale / first.z - by.scale / s.z <= by.tolerance &&
               std::abs(by.scale / first.image_z - by.scale / s.image_z) <= by.tolerance;
    constexpr double surface_depth_ratio = 1.01, largest_image_difference = 0.05;
    const bool one_image =
        s.image_z == first.image_z || std::abs(first.image_z / s.image_z - 1) <= largest_image_difference;
    return s.z <= surface_depth_ratio * first.z && one_image;
}

float offset(double sum, std::size_t count) { return float(std::clamp(sum / double(count), -0.5, 0.5)); }

// The mean position and depth of some samples; the mean of depths is harmonic.
struct PlaceSum {
    double x = 0, y = 0, inverse_z = 0, inverse_image_z = 0;
    std::size_t count = 0;

    void add(const Seen &s) {
        x += s.x, y += s.y;
        inverse_z += 1 / s.z, inverse_image_z += 1 / s.image_z;
        ++count;
    }
    void set(MergedSample &surface) const {
        surface.dx = offset(x, count), surface.dy = offset(y, count);
        surface.z = surface.z_back = float(double(count) / inverse_z);
        surface.image_z = float(double(count) / inverse_image_z);
    }
};

// The channels that ProxyFor::left multiplies: light without coverage.
std::vector<char> dimmed_channels(const Ldi &ldi, const ProxyFor &by) {
    std::vector<char> dimmed(ldi.channels.size(), false);
    if (by.left.empty()) return dimmed;
    for (std::size_t k = 0; k < dimmed.size(); ++k) dimmed[k] = is_light(ldi.channels[k]) && k != ldi.alpha();
    return dimmed;
}

// The surfaces of small pixels, one after the other.
class SurfacesOf {
public:
    SurfacesOf(const Ldi &ldi, std::size_t alpha, int factor, const ProxyFor &by)
        : ldi_(ldi), alpha_(alpha), factor_(factor), by_(by), dimmed_(dimmed_channels(ldi, by)) {}

    void append_to(Ldi &out, const Imath::V2i &small) const {
        // A share of the light. Surfaces that hide everything leave less, by rounding only.
        constexpr double nothing_left = 1e-4;
        thread_local std::vector<Seen> seen; // kept between calls, because there are many pixels
        thread_local std::vector<Term> terms;
        find_samples(ldi_, alpha_, small, factor_, by_.joined, seen);
        const double pixels = double(factor_) * factor_;
        double left = 1; // of the light, behind the surfaces so far
        for (std::size_t begin = 0, end = 0; begin < seen.size(); begin = end) {
            double shown = 0;
            PlaceSum place;
            terms.clear();
            for (; end < seen.size() && alike(seen[begin], seen[end], by_); ++end) {
                const Seen &s = seen[end];
                place.add(s);
                shown += s.shown * alpha_at(ldi_, alpha_, s.index) / pixels;
                terms.push_back({s.index, (left > nothing_left ? s.shown / left : 1) / pixels});
            }
            MergedSample surface = sample_at(ldi_, seen[begin].index);
            place.set(surface);
            surface.terms = terms;
            surface.solid = by_.scale > 0 ? most_solid_of(ldi_, terms) : solid_of(ldi_, alpha_, terms);
            append(out, surface);
            left = std::max(0.0, left - shown);
        }
    }

private:
    void append(Ldi &out, const MergedSample &surface) const {
        sparselens::append(out, ldi_, surface, [this](std::size_t k, std::uint64_t i) {
            return dimmed_[k] ? ldi_.values[k][i] * by_.left[i] : ldi_.values[k][i];
        });
        if (ldi_.dx.empty()) out.dx.push_back(surface.dx), out.dy.push_back(surface.dy);
        out.values[alpha_].back() = std::min(out.values[alpha_].back(), 1.0f); // exceeds 1 by rounding only
    }

    const Ldi &ldi_;
    std::size_t alpha_;
    int factor_;
    const ProxyFor &by_;
    std::vector<char> dimmed_; // [channel]
};

} // namespace

Ldi proxy(const Ldi &ldi, int factor, const ProxyFor &by) {
    if (factor == 1) return ldi;
    if (ldi.alpha() == npos) return proxy(with_coverage(ldi), factor, by);
    Ldi like = empty_like(ldi);
    Windows &windows = like.windows;
    windows.display = reduced(windows.display, factor);
    windows.data = reduced(windows.data, factor);
    Ldi out = with_each_coverage(ldi, [&](std::size_t coverage) {
        const SurfacesOf surfaces(ldi, coverage, factor, by);
        return build_by_pixels(
            like, [&](std::size_t pixel, Ldi &row) { surfaces.append_to(row, windows.pixel(pixel)); });
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
        for (const std::uint64_t i : ldi.pixel(ldi.windows.index(from))) append(row, ldi, i);
    });
    out.dx.clear(), out.dy.clear();
    return out;
}

namespace {
constexpr double sharp = 0.5; // pixels; light that reaches less far is not spread (lens_gather.h)
}

Ldi padded(Ldi ldi, const Imath::Box2i &data) {
    Windows windows = ldi.windows;
    windows.data.extendBy(data);
    if (windows == ldi.windows) return ldi;
    std::vector<std::uint64_t> begin{0};
    begin.reserve(windows.pixels() + 1);
    for (int y = windows.data.min.y; y <= windows.data.max.y; ++y)
        for (int x = windows.data.min.x; x <= windows.data.max.x; ++x) {
            const bool old = ldi.windows.data.intersects(Imath::V2i(x, y));
            begin.push_back(old ? ldi.begin[ldi.windows.index(Imath::V2i(x, y)) + 1] : begin.back());
        }
    ldi.begin = std::move(begin);
    ldi.windows = windows;
    return ldi;
}

Imath::Box2i reached_display(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks) {
    const Imath::Box2i &display = ldi.windows.display;
    const LightReach light(lens, looks, ldi.windows);
    Imath::Box2d reached;
    for (std::size_t pixel = 0; pixel < ldi.windows.pixels(); ++pixel) {
        const Imath::V2d own(ldi.windows.pixel(pixel)), at = own + Imath::V2d(0.5);
        for (const std::uint64_t i : ldi.pixel(pixel)) {
            const Imath::Box2d box = light.box(at, circle_of_confusion(lens, ldi.coc_z(i)));
            const Imath::V2d reach = box.size() / 2;
            if (std::max(reach.x, reach.y) < sharp && light.magnification() == 1) continue;
            const Imath::V2d whole(std::ceil(reach.x) + 1, std::ceil(reach.y) + 1); // pixels that it touches
            const Imath::V2d middle(std::floor(box.center().x), std::floor(box.center().y));
            reached.extendBy(Imath::Box2d(middle - whole, middle + whole));
            reached.extendBy(Imath::Box2d(own - whole, own + whole)); // the light before it is magnified
        }
    }
    Imath::Box2i box;
    for (int axis = 0; axis < 2; ++axis) {
        if (reached.max[axis] < display.min[axis] || reached.min[axis] > display.max[axis]) return {};
        box.min[axis] = int(std::max(reached.min[axis], double(display.min[axis])));
        box.max[axis] = int(std::min(reached.max[axis], double(display.max[axis])));
    }
    return box;
}

} // namespace sparselens
