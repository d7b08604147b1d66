#include "lab/reference/seen_slowly.h"

#include "lab/reference/facets_slowly.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace sparselens {

namespace {

constexpr long double infinity = std::numeric_limits<long double>::infinity();

// Bounds of full coverage and of nothing after rounding to halves: lens_gather_reference.h.
constexpr long double opaque = 0.9995L, clear = 1.0L / 2048;

long double coc_at(const ThinLens &lens, long double z) {
    const long double rf = (long double)lens.radius * lens.focal_px, d = lens.focus;
    if (std::isinf(d)) return -rf / z;
    return std::isinf(z) ? rf / d : rf / d * ((z - d) / z);
}

// All samples, and inside the window the backgrounds behind pixels that are not opaque, front to back.
std::vector<Placed> place_samples(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window) {
    std::vector<Placed> placed;
    for (int row = ldi.windows.data.min.y; row <= ldi.windows.data.max.y; ++row)
        for (int column = ldi.windows.data.min.x; column <= ldi.windows.data.max.x; ++column) {
            const std::size_t pixel = ldi.windows.index(Imath::V2i(column, row));
            const long double x = column + 0.5L, y = row + 0.5L;
            long double passed = 1;
            for (const std::uint64_t i : ldi.pixel(pixel)) {
                const long double dx = ldi.dx.empty() ? 0 : ldi.dx[i], dy = ldi.dy.empty() ? 0 : ldi.dy[i];
                const long double z = ldi.z[i], alpha = alpha_of(ldi, i);
                const long double image_coc = coc_at(lens, ldi.coc_z(i));
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

// The sample that a solid shows: the sample itself, or the nearest opaque one around it that is not behind the solid.
const Placed *shown_by(const Ldi &ldi, std::span<const Placed> samples, std::uint64_t own,
                       const Imath::V2i &pixel) {
    const auto holds = [&](const Imath::V2i &at, std::uint64_t i) {
        if (!ldi.windows.data.intersects(at)) return false;
        const SampleRange range = ldi.pixel(ldi.windows.index(at));
        return i >= range.from && i < range.to;
    };
    const bool is_partial = alpha_of(ldi, own) < opaque;
    const Placed *nearest = nullptr;
    long double least = infinity;
    for (int y = pixel.y - 1; y <= pixel.y + 1; ++y)
        for (int x = pixel.x - 1; x <= pixel.x + 1; ++x)
            for (std::uint64_t i = 0; i < ldi.samples(); ++i) {
                if (!holds({x, y}, i) || (!is_partial && i != own)) continue;
                const auto placed = std::ranges::find_if(
                    samples, [&](const Placed &s) { return !s.background && s.source == i; });
                const long double behind = 1.0L / ldi.z[own] - 1.0L / ldi.z[i];
                if (placed->alpha < 1 || placed->is_image() || behind > (long double)ldi.solid[own] ||
                    std::abs(behind) >= least)
                    continue;
                nearest = &*placed;
                least = std::abs(behind);
            }
    return nearest;
}

// Disparities, pixels.
long double depth_of(const ThinLens &lens, long double z) {
    return (long double)lens.radius * lens.focal_px / z;
}
long double depth_of(const ThinLens &lens, const Placed *sample) { return depth_of(lens, sample->z); }

// Whether most of the three by three pixels around a pixel hold the surface of one of its samples.
bool is_wide_slowly(const Ldi &ldi, const ThinLens &lens, const Imath::V2i &pixel, std::uint64_t sample) {
    const auto depth = [&](std::uint64_t i) { return depth_of(lens, ldi.z[i]); };
    int all = 0, same = 0;
    for (int y = pixel.y - 1; y <= pixel.y + 1; ++y)
        for (int x = pixel.x - 1; x <= pixel.x + 1; ++x) {
            if (!ldi.windows.data.intersects(Imath::V2i(x, y))) continue;
            const SampleRange range = ldi.pixel(ldi.windows.index(Imath::V2i(x, y)));
            bool holds = false;
            for (std::uint64_t i = range.from; i < range.to; ++i)
                holds = holds || std::abs(depth(i) - depth(sample)) < one_surface_px;
            ++all;
            same += holds;
        }
    return 2 * same > all;
}

// The solids behind samples, sorted by the depth from which they hide things.
std::vector<Placed> place_solids(const Ldi &ldi, const ThinLens &lens, std::span<const Placed> samples,
                                 std::span<const Placed> fillers) {
    std::vector<Placed> placed;
    for (const Placed &f : fillers) {
        const Filler::Part &part = f.filler->part[0];
        if (!f.filler->is_between || !is_wide_slowly(ldi, lens, ldi.windows.pixel(part.pixel), part.sample))
            continue;
        const auto shown = std::ranges::find_if(
            samples, [&](const Placed &s) { return !s.background && s.source == part.sample; });
        if (shown->alpha < 1 || shown->is_image()) continue;
        const long double hides = std::max(depth_of(lens, &f) - one_surface_px, 0.0L);
        placed.push_back({f.x, f.y, f.coc, (long double)lens.radius * lens.focal_px / hides, 1, shown->source,
                          false, nullptr, f.coc, &*shown});
    }
    for (const Placed &s : samples) {
        if (s.background || ldi.solid.empty() || !(ldi.solid[s.source] > 0)) continue;
        const long double solid = ldi.solid[s.source], hides = 1 / s.z - 2 * solid;
        const std::size_t pixel =
            std::size_t(std::ranges::upper_bound(ldi.begin, s.source) - ldi.begin.begin() - 1);
        const Placed *shown =
            hides > 0 ? shown_by(ldi, samples, s.source, ldi.windows.pixel(pixel)) : nullptr;
        if (!shown) continue;
        const long double coc = coc_at(lens, 1 / (1 / s.z - solid));
        placed.push_back({s.x, s.y, coc, 1 / hides, 1, shown->source, false, nullptr, coc, shown});
    }
    std::ranges::stable_sort(placed, {}, &Placed::z);
    return placed;
}

// Rounds as the gather does. It adds 32768.5 in float, and the sum's own rounding takes some values below a half upwards.
long double whole(long double exact) { return std::floor((long double)(float(exact) + 32768.5f)) - 32768; }

// The margin of one coordinate of a sample's square, from the pixel that a lens point looks at. `looks`: from where in
// the pixel.
Margin margin(long double sample, long double coc, long double lens, long double looks, int pixel, int middle,
              const Rounding &by) {
    const long double coc_units = coc * by.lens_unit * by.unit, place = (sample - middle) * by.unit,
                      lens_units = std::clamp(whole(lens / by.lens_unit * 32768), -32767.0L, 32767.0L),
                      moved = std::floor(whole(coc_units) * lens_units / 32768 + 0.5L),
                      seen = whole(place) + moved + std::floor(looks * by.unit) - (pixel - middle) * by.unit;
    const auto is_unsure = [](long double exact, long double off) {
        return whole(exact - off) != whole(exact + off);
    };
    // Units by which rounding in float may move the sample.
    const int unsure =
        is_unsure(coc_units, 1.2e-7L * std::abs(coc_units)) + is_unsure(place, 1.2e-7L * by.extent * by.unit);
    return {(by.unit / 2 - std::abs(seen + 0.5L - by.unit / 2)) / by.unit, (unsure + 0.25L) / by.unit};
}

long double passes(const Placed &s, const Pixel &pixel) {
    const bool held_out = pixel.holdout && !s.background;
    return held_out ? (long double)pixel.holdout->passes(pixel.x, pixel.y, double(s.shows().z)) : 1;
}

// Whether the lens point sees the sample in its unit square, and whether rounding matters.
Cover covers(const Placed &s, const LensSample &point, const Pixel &pixel) {
    const Margin across = margin(s.x, s.coc, point.x, point.pixel_x, pixel.x, pixel.middle.x, pixel.rounding);
    const Margin down = margin(s.y, s.coc, point.y, point.pixel_y, pixel.y, pixel.middle.y, pixel.rounding);
    if (across.outside() || down.outside()) return {};
    return {true, across.inside > 0 && down.inside > 0, across.sure() && down.sure()};
}

// The samples that the lens point meets in the pixel, front to back, up to the first that certainly hides the rest.
void meet(const ThinLens &lens, std::span<const Placed> samples,
          std::span<const std::array<std::size_t, 3>> facets, const LensSample &point, const Pixel &pixel,
          std::vector<Met> &met) {
    met.clear();
    const Placed *hides = nullptr; // what certainly hides all that is farther
    const Imath::Vec2<long double> at(pixel.x + 0.5L - (long double)point.pixel_x,
                                      pixel.y + 0.5L - (long double)point.pixel_y);
    std::vector<Cover> by_facets;
    cover_by_facets(samples, facets, point, at, pixel.rounding.extent, by_facets);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Placed &s = samples[i];
        if (hides && s.z == hides->z) continue;
        if (hides && depth_of(lens, hides) - depth_of(lens, &s) >= pixel.rounding.depth) return;
        Cover cover = covers(s, point, pixel);
        if (!by_facets.empty()) cover.add(by_facets[i]);
        if (!cover.possible) continue;
        for (Met &m : met) // the order of two opaque samples may be the other one
            if (s.alpha == 1 && m.sample->alpha == 1 && m.sample->z < s.z &&
                depth_of(lens, m.sample) - depth_of(lens, &s) < pixel.rounding.depth)
                m.sure = false;
        met.push_back({&s, cover.seen, cover.sure, passes(s, pixel)});
        if (cover.sure && s.alpha == 1 && !hides) hides = &s;
    }
}

// The candidates for the nearest opaque thing that a lens point meets, null for none; and the one it is without
// rounding.
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

// Adds the solids that hide something opaque in `met`.
void add_solids(const Scene &scene, const LensSample &point, const Pixel &pixel, std::vector<Met> &met) {
    if (scene.solids.empty()) return;
    std::vector<Met> solids;
    meet(scene.lens, scene.solids, {}, point, pixel, solids);
    for (const Met &solid : solids) {
        const auto behind =
            std::ranges::find_if(met, [&](const Met &m) { return m.sample->z > solid.sample->z; });
        const auto hidden =
            std::find_if(behind, met.end(), [](const Met &m) { return m.sample->alpha == 1; });
        if (hidden == met.end()) continue;
        if (solid.sure) met.erase(behind, met.end());
        met.insert(solid.sure ? met.end() : behind, solid);
    }
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

// The first opaque things that a lens point meets in the neighbouring pixels: left, right, above, below, and in the
// corners: above right, below left, above left, below right.
using Around = std::array<Choice, 8>;

Around fronts_around(const Scene &scene, const LensSample &point, const Pixel &pixel) {
    const auto front_beside = [&](int dx, int dy) {
        std::vector<Met> met;
        meet(scene.lens, scene.samples, scene.facets, point,
             {pixel.x + dx, pixel.y + dy, pixel.middle, pixel.rounding, nullptr}, met);
        add_solids(scene, point, {pixel.x + dx, pixel.y + dy, pixel.middle, pixel.rounding, nullptr}, met);
        return front_of(met);
    };
    return {front_beside(-1, 0), front_beside(1, 0),  front_beside(0, -1),  front_beside(0, 1),
            front_beside(1, -1), front_beside(-1, 1), front_beside(-1, -1), front_beside(1, 1)};
}

const Placed *farther(const Placed *first, const Placed *second) {
    if (!first || !second) return first ? first : second;
    return second->z > first->z ? second : first;
}
const Placed *shown_farther(const Placed *first, const Placed *second) {
    if (!first || !second) return first ? first : second;
    return second->shows().z > first->shows().z ? second : first;
}

// The sample that a lens point sees through a crack in front of `behind`; null: nothing.
Choice torn_between(const ThinLens &lens, const Around &around, const Placed *behind) {
    const auto may_be_before = [&](const Placed *s) {
        if (!s || s->background) return false;
        return !behind || depth_of(lens, s) > depth_of(lens, behind) + 1;
    };
    const auto torn = [&](const Placed *a, const Placed *b) -> const Placed * {
        if (!may_be_before(a) || !may_be_before(b)) return nullptr;
        const Placed &left = a->shows(), &right = b->shows();
        if (std::abs(left.x - right.x) >= 1.5L || std::abs(left.y - right.y) >= 1.5L) return nullptr;
        const long double apart = depth_of(lens, &left) - depth_of(lens, &right);
        return std::abs(apart) < one_surface_px ? shown_farther(a, b) : nullptr;
    };
    Choice farthest = combined(around[0], around[1], torn);
    for (std::size_t k = 2; k < around.size(); k += 2)
        farthest = combined(farthest, combined(around[k], around[k + 1], torn), shown_farther);
    return farthest;
}

// The nearest depth that has something at least as near on both sides of a lens point.
Choice screen_between(const Around &around) {
    const auto both = [](const Placed *a, const Placed *b) { return a && b ? farther(a, b) : nullptr; };
    const auto nearer = [](const Placed *a, const Placed *b) {
        return a && b ? (b->z < a->z ? b : a) : a ? a : b;
    };
    return combined(combined(around[0], around[1], both), combined(around[2], around[3], both), nearer);
}

// The nearest image in a pixel.
Choice image_in(const Scene &scene, const LensSample &point, const Pixel &pixel, int dx, int dy) {
    Choice nearest;
    std::vector<const Placed *> sure;
    for (const Placed &s : scene.samples) {
        if (!s.is_image()) continue;
        const Margin across = margin(s.x, s.image_coc, point.x, point.pixel_x, pixel.x + dx, pixel.middle.x,
                                     pixel.rounding),
                     down = margin(s.y, s.image_coc, point.y, point.pixel_y, pixel.y + dy, pixel.middle.y,
                                   pixel.rounding);
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
        std::erase_if(nearest.can_be, [&](const Placed *s) {
            return s->image_coc > (*first)->image_coc + pixel.rounding.image;
        });
    return nearest;
}

// What a mirror shows: the nearest image in the pixel, else in a neighbouring pixel, else the colour of its surface.
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

// The sort order; of two at one depth, a solid comes first.
bool before(const Placed *a, const Placed *b) {
    return a->z != b->z ? a->z < b->z : a->shown || (!b->shown && a < b);
}

// Replaces the mirrors of a way by the images that they show, one way for each choice.
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

// A lens point sees partial samples in front of a surface that shows through a crack.
Way through_crack(const std::vector<Met> &partial, const Placed *torn, bool is, const Pixel &pixel) {
    Way way{partial, is};
    const auto behind = std::ranges::find_if(way.met, [&](const Met &m) { return before(torn, m.sample); });
    way.met.insert(behind, {torn, true, true, passes(*torn, pixel)});
    return way;
}

// Adds ways that see a surface through a crack in front of everything opaque in the pixel.
void add_ways_before(std::vector<Way> &ways, const std::vector<Met> &partial, const Choice &torn,
                     const Pixel &pixel) {
    for (const Placed *sample : torn.can_be)
        if (sample) ways.push_back(through_crack(partial, sample, sample == torn.is, pixel));
}

// Adds ways of a lens point that meets only partial samples: behind them it sees a surface through a crack, or a
// filler.
void add_ways_through(std::vector<Way> &ways, const std::vector<Met> &partial, bool is, const Scene &scene,
                      const Around &around, const LensSample &point, const Pixel &pixel) {
    const Choice torn = torn_between(scene.lens, around, nullptr), screen = screen_between(around);
    std::vector<Met> met;
    meet(scene.lens, scene.fillers, {}, point, pixel, met);
    const Choice filler = front_of(met);
    const auto add_filler = [&](const Placed *f, const Placed *before) {
        const bool hidden =
            f && before && depth_of(scene.lens, before) > depth_of(scene.lens, f) + one_surface_px;
        ways.push_back({partial, is && !torn.is && f == filler.is && before == screen.is});
        if (f && !hidden) ways.back().met.push_back({f, true, true, passes(*f, pixel)});
    };
    for (const Placed *sample : torn.can_be) {
        if (sample) {
            ways.push_back(through_crack(partial, sample, is && sample == torn.is, pixel));
            continue;
        }
        for (const Placed *f : filler.can_be)
            for (const Placed *before : screen.can_be) add_filler(f, before);
    }
}

// The samples seen through cracks in front of any of the candidates; null: the candidate itself is seen.
Choice torn_before(const ThinLens &lens, const Around &around, const Choice &front) {
    Choice torn;
    for (const Placed *met : front.can_be) {
        if (!met) continue;
        const Choice here = torn_between(lens, around, met);
        if (met == front.is) torn.is = here.is;
        torn.can_be.insert(torn.can_be.end(), here.can_be.begin(), here.can_be.end());
    }
    std::ranges::sort(torn.can_be);
    torn.can_be.erase(std::unique(torn.can_be.begin(), torn.can_be.end()), torn.can_be.end());
    return torn;
}

} // namespace

long double alpha_of(const Ldi &ldi, std::uint64_t sample) {
    return ldi.alpha() == npos ? 1.0L : (long double)std::clamp(ldi.values[ldi.alpha()][sample], 0.0f, 1.0f);
}

Scene place_scene(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                  std::span<const Filler> fillers) {
    Scene scene{lens, place_samples(ldi, lens, window), place_fillers(ldi, lens, fillers), {}, {}};
    scene.facets = place_facets_slowly(ldi, lens, scene.samples);
    scene.solids = place_solids(ldi, lens, scene.samples, scene.fillers);
    return scene;
}

Scene near(const Scene &scene, const Pixel &pixel, long double widest) {
    long double coc = 0;
    for (const auto *some : {&scene.samples, &scene.fillers, &scene.solids})
        for (const Placed &s : *some) coc = std::max({coc, std::abs(s.coc), std::abs(s.image_coc)});
    // Samples may be half a pixel off, those of a facet up to two pixels apart, and a pixel looks at its neighbours.
    const long double reach = coc * widest + 4;
    const auto is_near = [&](const Placed &s) {
        return std::abs(s.x - pixel.x - 0.5L) <= reach && std::abs(s.y - pixel.y - 0.5L) <= reach;
    };
    // A facet covers nothing outside the box that its corners span when each is moved as far as the lens may move it.
    const auto may_cover = [&](const std::array<std::size_t, 3> &facet) {
        long double left = infinity, right = -infinity, top = infinity, bottom = -infinity;
        for (const std::size_t corner : facet) {
            const Placed &s = scene.samples[corner];
            const long double moved = std::abs(s.coc) * widest + 4;
            left = std::min(left, s.x - moved), right = std::max(right, s.x + moved);
            top = std::min(top, s.y - moved), bottom = std::max(bottom, s.y + moved);
        }
        return left <= pixel.x + 0.5L && right >= pixel.x + 0.5L && top <= pixel.y + 0.5L &&
               bottom >= pixel.y + 0.5L;
    };
    Scene part{scene.lens, {}, {}, {}, {}};
    std::vector<std::size_t> place(scene.samples.size(), 0); // index in `part`, plus 1; 0: left out
    for (std::size_t i = 0; i < scene.samples.size(); ++i)
        if (is_near(scene.samples[i])) {
            part.samples.push_back(scene.samples[i]);
            place[i] = part.samples.size();
        }
    std::ranges::copy_if(scene.fillers, std::back_inserter(part.fillers), is_near);
    std::ranges::copy_if(scene.solids, std::back_inserter(part.solids), is_near);
    for (const auto &facet : scene.facets) {
        const auto &[a, b, c] = facet;
        if (place[a] && place[b] && place[c] && may_cover(facet))
            part.facets.push_back({place[a] - 1, place[b] - 1, place[c] - 1});
    }
    return part;
}

std::vector<Way> ways_to_see(const Scene &scene, const LensSample &point, const Pixel &pixel) {
    std::vector<Met> met, partial;
    meet(scene.lens, scene.samples, scene.facets, point, pixel, met);
    const Choice front = front_of(met);
    std::ranges::copy_if(met, std::back_inserter(partial), [](const Met &m) { return m.sample->alpha < 1; });
    add_solids(scene, point, pixel, met);
    const Around around = fronts_around(scene, point, pixel);
    const Choice torn = torn_before(scene.lens, around, front_of(met));
    std::vector<Way> ways;
    if (std::ranges::find(torn.can_be, nullptr) != torn.can_be.end())
        ways = with_images({met, front.is && !torn.is}, scene, point, pixel);
    add_ways_before(ways, partial, torn, pixel);
    if (!front.can_be.back()) add_ways_through(ways, partial, !front.is, scene, around, point, pixel);
    return ways;
}

} // namespace sparselens
