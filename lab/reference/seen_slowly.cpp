#include "lab/reference/seen_slowly.h"

#include "lab/reference/facets_slowly.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace sparselens {

namespace {

constexpr long double infinity = std::numeric_limits<long double>::infinity();

// What rounding to halves leaves of full coverage, and of nothing: lens_gather_reference.h.
constexpr long double opaque = 0.9995L, clear = 1.0L / 2048;

long double coc_at(const ThinLens &lens, long double z) {
    const long double rf = (long double)lens.radius * lens.focal_px, d = lens.focus;
    if (std::isinf(d)) return -rf / z;
    return std::isinf(z) ? rf / d : rf / d * ((z - d) / z);
}

// All samples, and inside the window the backgrounds behind what is not opaque, front to back.
std::vector<Placed> place_samples(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window) {
    std::vector<Placed> placed;
    for (int row = ldi.windows.data.min.y; row <= ldi.windows.data.max.y; ++row)
        for (int column = ldi.windows.data.min.x; column <= ldi.windows.data.max.x; ++column) {
            const std::size_t pixel = ldi.windows.index(column, row);
            const long double x = column + 0.5L, y = row + 0.5L;
            long double passed = 1;
            for (const std::uint64_t i : ldi.pixel(pixel)) {
                const long double dx = ldi.dx.empty() ? 0 : ldi.dx[i], dy = ldi.dy.empty() ? 0 : ldi.dy[i];
                const long double z = ldi.z[i], alpha = alpha_of(ldi, i);
                const long double image_coc = coc_at(lens, ldi.optical_z(i));
                const long double coc = alpha < opaque ? image_coc : coc_at(lens, z);
                placed.push_back(
                    {x + dx, y + dy, coc, z, alpha < opaque ? alpha : 1, i, false, nullptr, image_coc});
                passed *= 1 - alpha;
            }
            if (passed < clear || !window.intersects(Imath::V2i(column, row))) continue;
            if (!ldi.pixel(pixel).empty()) {
                const Placed last = placed.back();
                placed.push_back({last.x, last.y, last.image_coc, infinity, 1, 0, true});
            }
            placed.push_back({x, y, coc_at(lens, infinity), infinity, 1, 0, true});
        }
    std::stable_sort(placed.begin(), placed.end(), [](const Placed &a, const Placed &b) {
        return a.z != b.z ? a.z < b.z : !a.background && b.background;
    });
    return placed;
}

std::vector<Placed> place_fillers(const Ldi &ldi, const ThinLens &lens, std::span<const Filler> fillers) {
    std::vector<Placed> placed;
    for (const Filler &f : fillers) {
        const Imath::V2i at = ldi.windows.pixel(f.pixel);
        const long double z = f.is_nothing() ? infinity : (long double)f.z;
        placed.push_back({at.x + 0.5L, at.y + 0.5L, coc_at(lens, z), z, 1, 0, f.is_nothing(), &f});
    }
    std::ranges::stable_sort(placed, {}, &Placed::z);
    return placed;
}

// Of one coordinate of a sample's square.
Margin margin(long double sample, long double displaced, long double looked_at, long double extent) {
    return {0.5L - std::abs(sample + displaced - looked_at), 5e-7L * extent + 1e-6L * std::abs(displaced)};
}

long double passes(const Placed &s, const Pixel &pixel) {
    const bool held_out = pixel.holdout && !s.background;
    return held_out ? (long double)pixel.holdout->passes(pixel.x, pixel.y, double(s.z)) : 1;
}

// Whether the lens point sees the sample in its unit square, and whether rounding does not matter.
Cover covers(const Placed &s, const LensSample &point, const Imath::Vec2<long double> &at,
             long double extent) {
    const Margin across = margin(s.x, s.coc * (long double)point.x, at.x, extent);
    const Margin down = margin(s.y, s.coc * (long double)point.y, at.y, extent);
    if (across.outside() || down.outside()) return {};
    return {true, across.inside > 0 && down.inside > 0, across.sure() && down.sure()};
}

// What the lens point meets in the pixel, front to back, up to the first that certainly hides all else.
void meet(std::span<const Placed> samples, std::span<const std::array<std::size_t, 3>> facets,
          const LensSample &point, const Pixel &pixel, std::vector<Met> &met) {
    met.clear();
    const Imath::Vec2<long double> at(pixel.x + 0.5L - (long double)point.pixel_x,
                                      pixel.y + 0.5L - (long double)point.pixel_y);
    std::vector<Cover> by_facets;
    cover_by_facets(samples, facets, point, at, pixel.extent, by_facets);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Placed &s = samples[i];
        Cover cover = covers(s, point, at, pixel.extent);
        if (!by_facets.empty()) cover.add(by_facets[i]);
        if (!cover.possible) continue;
        met.push_back({&s, cover.seen, cover.sure, passes(s, pixel)});
        if (cover.sure && s.alpha == 1) return;
    }
}

// What can be the nearest opaque thing that a lens point meets, null for none; and which it is.
struct Choice {
    const Placed *is = nullptr;
    std::vector<const Placed *> can_be;
};

Choice front_of(std::span<const Met> met) {
    Choice front;
    bool sure = false;
    for (const Met &m : met) {
        if (m.sample->alpha < 1) continue;
        if (m.seen && !front.is) front.is = m.sample;
        front.can_be.push_back(m.sample);
        sure = sure || m.sure;
    }
    if (!sure) front.can_be.push_back(nullptr);
    return front;
}

template <typename Combine>
Choice combined(const Choice &a, const Choice &b, const Combine &combine) {
    Choice both{combine(a.is, b.is), {}};
    for (const Placed *one : a.can_be)
        for (const Placed *other : b.can_be) both.can_be.push_back(combine(one, other));
    std::ranges::sort(both.can_be);
    both.can_be.erase(std::unique(both.can_be.begin(), both.can_be.end()), both.can_be.end());
    return both;
}

// What a lens point meets first in the pixels around one: left, right, above, below.
using Around = std::array<Choice, 4>;

Around fronts_around(const Scene &scene, const LensSample &point, const Pixel &pixel) {
    const auto front_beside = [&](int dx, int dy) {
        std::vector<Met> met;
        meet(scene.samples, scene.facets, point, {pixel.x + dx, pixel.y + dy, pixel.extent, nullptr}, met);
        return front_of(met);
    };
    return {front_beside(-1, 0), front_beside(1, 0), front_beside(0, -1), front_beside(0, 1)};
}

long double depth_of(const ThinLens &lens, const Placed *sample) {
    return (long double)lens.radius * lens.focal_px / sample->z;
}

const Placed *farther(const Placed *first, const Placed *second) {
    if (!first || !second) return first ? first : second;
    return second->z > first->z ? second : first;
}

// The sample that a lens point sees through a crack.
Choice torn_between(const ThinLens &lens, const Around &around) {
    const auto torn = [&](const Placed *a, const Placed *b) -> const Placed * {
        if (!a || !b || a->background || b->background) return nullptr;
        if (std::abs(a->x - b->x) >= 1.5L || std::abs(a->y - b->y) >= 1.5L) return nullptr;
        return std::abs(depth_of(lens, a) - depth_of(lens, b)) < one_surface_px ? farther(a, b) : nullptr;
    };
    return combined(combined(around[0], around[1], torn), combined(around[2], around[3], torn), farther);
}

// The nearest thing such that something as near as it lies on either side of a lens point.
Choice screen_between(const Around &around) {
    const auto both = [](const Placed *a, const Placed *b) { return a && b ? farther(a, b) : nullptr; };
    const auto nearer = [](const Placed *a, const Placed *b) { return a && b ? std::min(a, b) : a ? a : b; };
    return combined(combined(around[0], around[1], both), combined(around[2], around[3], both), nearer);
}

// The nearest image that lies in a pixel.
Choice image_in(const Scene &scene, const LensSample &point, const Pixel &pixel, int dx, int dy) {
    const long double x = pixel.x + dx + 0.5L - (long double)point.pixel_x,
                      y = pixel.y + dy + 0.5L - (long double)point.pixel_y;
    Choice nearest;
    std::vector<const Placed *> sure;
    for (const Placed &s : scene.samples) {
        if (!s.is_image()) continue;
        const Margin across = margin(s.x, s.image_coc * (long double)point.x, x, pixel.extent),
                     down = margin(s.y, s.image_coc * (long double)point.y, y, pixel.extent);
        if (across.outside() || down.outside()) continue;
        nearest.can_be.push_back(&s);
        if (across.inside > across.unclear && down.inside > down.unclear) sure.push_back(&s);
        if (across.inside > 0 && down.inside > 0 && (!nearest.is || s.image_coc < nearest.is->image_coc))
            nearest.is = &s;
    }
    const auto first = std::ranges::min_element(sure, {}, &Placed::image_coc);
    if (first == sure.end())
        nearest.can_be.push_back(nullptr);
    else
        std::erase_if(nearest.can_be, [&](const Placed *s) { return s->image_coc > (*first)->image_coc; });
    return nearest;
}

// What is seen of a mirror: the nearest image in the pixel, else in one beside it, else what its surface shows.
Choice image_of(const Placed &mirror, const Scene &scene, const LensSample &point, const Pixel &pixel) {
    const auto of_mirror = [&](const Placed *s) {
        return s && std::abs(depth_of(scene.lens, s) - depth_of(scene.lens, &mirror)) < 1 ? s : nullptr;
    };
    Choice seen;
    constexpr std::array<std::array<int, 2>, 5> places{{{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
    for (const auto &[dx, dy] : places) {
        const Choice here = image_in(scene, point, pixel, dx, dy);
        if (!seen.is) seen.is = of_mirror(here.is);
        bool may_be_none = false;
        for (const Placed *s : here.can_be)
            of_mirror(s) ? seen.can_be.push_back(s) : void(may_be_none = true);
        if (!may_be_none) return seen;
    }
    if (!seen.is) seen.is = &mirror;
    seen.can_be.push_back(&mirror);
    return seen;
}

// The ways to see what the mirrors that a way meets show.
std::vector<Way> with_images(const Way &way, const Scene &scene, const LensSample &point,
                             const Pixel &pixel) {
    std::vector<Way> ways{way};
    for (std::size_t m = 0; m < way.met.size(); ++m) {
        if (!way.met[m].sample->is_image()) continue;
        const Choice image = image_of(*way.met[m].sample, scene, point, pixel);
        const std::vector<Way> before = std::move(ways);
        ways.clear();
        for (const Way &one : before)
            for (const Placed *s : image.can_be) {
                ways.push_back(one);
                ways.back().met[m].sample = s;
                ways.back().is = one.is && s == image.is;
            }
    }
    return ways;
}

// A lens point that meets partial samples alone sees them before what it sees through a crack, or before a filler.
void add_ways_through(std::vector<Way> &ways, const std::vector<Met> &partial, bool is, const Scene &scene,
                      const LensSample &point, const Pixel &pixel) {
    const Around around = fronts_around(scene, point, pixel);
    const Choice torn = torn_between(scene.lens, around), screen = screen_between(around);
    std::vector<Met> met;
    meet(scene.fillers, {}, point, pixel, met);
    const Choice filler = front_of(met);
    const auto add_filler = [&](const Placed *f, const Placed *before) {
        const bool hidden =
            f && before && depth_of(scene.lens, before) > depth_of(scene.lens, f) + one_surface_px;
        ways.push_back({partial, is && !torn.is && f == filler.is && before == screen.is});
        if (f && !hidden) ways.back().met.push_back({f, true, true, passes(*f, pixel)});
    };
    for (const Placed *sample : torn.can_be) {
        if (!sample) {
            for (const Placed *f : filler.can_be)
                for (const Placed *before : screen.can_be) add_filler(f, before);
            continue;
        }
        ways.push_back({partial, is && sample == torn.is});
        std::vector<Met> &seen = ways.back().met;
        const auto behind = std::ranges::find_if(seen, [&](const Met &m) { return m.sample > sample; });
        seen.insert(behind, {sample, true, true, passes(*sample, pixel)});
    }
}

} // namespace

long double alpha_of(const Ldi &ldi, std::uint64_t sample) {
    return ldi.alpha() == npos ? 1.0L : (long double)std::clamp(ldi.values[ldi.alpha()][sample], 0.0f, 1.0f);
}

Scene place_scene(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                  std::span<const Filler> fillers) {
    Scene scene{lens, place_samples(ldi, lens, window), place_fillers(ldi, lens, fillers), {}};
    scene.facets = place_facets_slowly(ldi, lens, scene.samples);
    return scene;
}

std::vector<Way> ways_to_see(const Scene &scene, const LensSample &point, const Pixel &pixel) {
    std::vector<Met> met, partial;
    meet(scene.samples, scene.facets, point, pixel, met);
    const Choice front = front_of(met);
    if (front.can_be.back()) return with_images({met, true}, scene, point, pixel);
    std::vector<Way> ways;
    if (front.can_be.size() > 1) ways = with_images({met, front.is != nullptr}, scene, point, pixel);
    std::ranges::copy_if(met, std::back_inserter(partial), [](const Met &m) { return m.sample->alpha < 1; });
    add_ways_through(ways, partial, !front.is, scene, point, pixel);
    return ways;
}

} // namespace sparselens
