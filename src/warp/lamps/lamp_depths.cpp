#include "warp/lamps/lamp_depths.h"

#include "base/parallel.h"
#include "warp/lamps/lamp_light.h"
#include "warp/tuning.h"

#include <Imath/ImathVec.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

namespace sparselens {

// Finds the depth of small lamps for which all views have the depth of what is behind. All views must show a lamp where
// its depth says that they do: in the others its light would stay at the wall, and the lamp would show twice.

// A lamp in front of everything around it.
struct KnownLamp {
    Imath::V2d place{0, 0}; // its middle
    double light = 0;
    double inverse_z = 0; // 0: not known
};

inline bool is_same_light(const KnownLamp &a, const KnownLamp &b) {
    return std::abs(a.light - b.light) <= 0.33 * b.light;
}

struct LampBeforeWall {
    KnownLamp lamp;    // its depth is not known
    double around = 0; // 1 / z of the nearest thing around
};

// Returns the lamps with their positions in the centre view. `lamps`: of each view by rows. More than
// WarpTuning::most_lamps in a view are noise, and give no result. Depths whose inverses differ by less than `tolerance`
// are one surface. Lamps that may as well lie on what is around them are left out.
std::vector<KnownLamp> depths_by_parallax(std::span<const std::vector<LampBeforeWall>> lamps,
                                          std::span<const ViewMapping> mappings, double tolerance);

namespace {

// A lamp of a view.
struct SeenLamp {
    KnownLamp lamp;          // inverse_z is 0 if all its pixels have depths that occur around it
    double around = 0;       // 1 / z of the nearest thing around; behind a lamp of known depth
    bool is_crossed = false; // whether something around is in front of it
    std::vector<Imath::V2i> all;
    std::vector<Imath::V2i> pixels; // those whose light belongs at the lamp's depth
    std::vector<Imath::V2i> at_its_depth;
    bool repaired = false; // by other views
};

bool is_small(std::span<const Imath::V2i> pixels) {
    Imath::Box2i box;
    for (const Imath::V2i &p : pixels) box.extendBy(p);
    return box.size().x < WarpTuning::small_lamp && box.size().y < WarpTuning::small_lamp;
}

double inverse_z_at(const ViewSamples &view, const Imath::V2i &p) {
    const SampleRange shown = view.pixel(view.windows.index(p));
    return shown.empty() ? 0 : 1 / double(view.z(shown.front()));
}

// The depths that pixels two or three pixels from a lamp show.
struct Around {
    std::vector<double> inverse_z; // the nearest last
    bool whole = true;             // the border of the view cuts off none of it
};

Around look_around(const ViewSamples &view, std::span<const Imath::V2i> pixels) {
    const std::vector<Imath::V2i> edge = grown(pixels, 1);
    Around around;
    for (const Imath::V2i &p : grown(pixels, WarpTuning::lamp_gap)) {
        if (!view.windows.data.intersects(p))
            around.whole = false;
        else if (!is_among(edge, p))
            around.inverse_z.push_back(inverse_z_at(view, p));
    }
    std::ranges::sort(around.inverse_z);
    return around;
}

class LampsOfView {
public:
    LampsOfView(ViewSamples &view, double tolerance);
    std::span<const SeenLamp> lamps() const { return lamps_; }
    void repair_by_neighbours();
    // The pixels of lamps that something crosses, ascending.
    std::vector<std::size_t> crossed() const;
    // The lamps whose depth is not known, by rows.
    std::vector<LampBeforeWall> unknown() const;
    // Gives lamps of unknown depth that of `others` at the same place, whose positions are in the centre view.
    void repair_by_others(const ViewMapping &mapping, std::span<const KnownLamp> others);

private:
    SeenLamp look_at(const CompactLamp &found, std::span<const double> around) const;
    double depth_of(const CompactLamp &found, std::span<const double> around) const;
    double light_at(const Imath::V2i &p) const { return light_.at(view_.windows.index(p)); }
    void move(const Imath::V2i &pixel, double inverse_z);

    ViewSamples &view_;
    PixelLight<ViewSamples> light_;
    double tolerance_;
    std::vector<SeenLamp> lamps_;
};

LampsOfView::LampsOfView(ViewSamples &view, double tolerance)
    : view_(view), light_(view), tolerance_(tolerance) {
    if (!light_.is_known()) return;
    for (const CompactLamp &found : find_compact_lamps(view.windows.grid(), light_.picture())) {
        const Around around = look_around(view, found.pixels);
        if (around.inverse_z.empty()) continue;
        SeenLamp seen = look_at(found, around.inverse_z);
        // Something in front of it may lie beyond the border; strands that cross a lamp of known depth are visible.
        if (around.whole || (seen.is_crossed && seen.lamp.inverse_z != 0)) lamps_.push_back(std::move(seen));
    }
}

// Returns 1 / z of the lamp, which nothing around has. If the lamp is in front of everything around, the result is 1 /
// z of its nearest pixel. Else strands or bars may cross the lamp, and the result is 1 / z of the brightest pixel that
// has neither their depth nor the depth of what is behind. 0: not known.
double LampsOfView::depth_of(const CompactLamp &found, std::span<const double> around) const {
    double nearest = 0, brightest = 0, depth = 0;
    for (const Imath::V2i &p : found.pixels) {
        const double inverse_z = inverse_z_at(view_, p), light = light_at(p);
        nearest = std::max(nearest, inverse_z);
        const auto above = std::ranges::lower_bound(around, inverse_z - tolerance_);
        const bool is_around = above != around.end() && *above <= inverse_z + tolerance_;
        if (is_around || light <= brightest) continue;
        brightest = light;
        depth = inverse_z;
    }
    return nearest > around.back() + tolerance_ ? nearest : depth;
}

SeenLamp LampsOfView::look_at(const CompactLamp &found, std::span<const double> around) const {
    SeenLamp seen{{}, around.back(), false, found.pixels, {}, {}, false};
    KnownLamp &lamp = seen.lamp;
    const double enough =
        is_small(found.pixels) ? 0 : WarpTuning::lamp_edge_share * light_at(found.pixels[0]);
    for (const Imath::V2i &p : found.pixels) {
        const double light = light_at(p);
        if (light >= enough) seen.pixels.push_back(p);
        lamp.light += light;
        lamp.place += light * (Imath::V2d(p) + Imath::V2d(0.5));
    }
    lamp.place /= lamp.light;
    const double depth = depth_of(found, around);
    if (depth == 0) { // it may belong to what is around, and lies where it shines most
        seen.is_crossed = around.back() > inverse_z_at(view_, found.pixels[0]) + tolerance_;
        return seen;
    }
    const auto before = std::ranges::upper_bound(around, depth);
    seen.is_crossed = before != around.end();
    seen.around = before != around.begin() ? *(before - 1) : 0;
    double sum = 0, total = 0;
    for (const Imath::V2i &p : found.pixels) {
        const double inverse_z = inverse_z_at(view_, p), light = light_at(p);
        if (std::abs(inverse_z - depth) > tolerance_) continue;
        seen.at_its_depth.push_back(p);
        sum += light * inverse_z;
        total += light;
    }
    lamp.inverse_z = sum / total;
    return seen;
}

void LampsOfView::move(const Imath::V2i &pixel, double inverse_z) {
    const SampleRange shown = view_.pixel(view_.windows.index(pixel));
    if (!shown.empty()) view_.set_z(shown.front(), float(1 / inverse_z));
}

void LampsOfView::repair_by_neighbours() {
    for (const SeenLamp &seen : lamps_) {
        if (seen.lamp.inverse_z == 0) continue;
        const std::vector<Imath::V2i> beside = grown(seen.at_its_depth, 1);
        for (const Imath::V2i &p : seen.pixels) {
            const bool of_what_is_around = inverse_z_at(view_, p) < seen.around + tolerance_;
            if (of_what_is_around && (seen.is_crossed || is_among(beside, p))) move(p, seen.lamp.inverse_z);
        }
    }
}

std::vector<std::size_t> LampsOfView::crossed() const {
    std::vector<std::size_t> pixels;
    for (const SeenLamp &seen : lamps_)
        if (seen.is_crossed)
            for (const Imath::V2i &p : seen.all) pixels.push_back(view_.windows.index(p));
    std::ranges::sort(pixels);
    return pixels;
}

std::vector<LampBeforeWall> LampsOfView::unknown() const {
    std::vector<LampBeforeWall> found;
    for (const SeenLamp &seen : lamps_)
        if (!seen.repaired && seen.lamp.inverse_z == 0 && is_small(seen.pixels))
            found.push_back({seen.lamp, seen.around});
    std::ranges::stable_sort(found, {}, [](const LampBeforeWall &of) { return of.lamp.place.y; });
    return found;
}

void LampsOfView::repair_by_others(const ViewMapping &mapping, std::span<const KnownLamp> others) {
    std::vector<KnownLamp> expected(others.begin(), others.end());
    for (KnownLamp &lamp : expected) lamp.place = mapping.in_view(lamp.place, lamp.inverse_z);
    std::erase_if(expected, [](const KnownLamp &lamp) { return !std::isfinite(lamp.place.y); });
    const auto row = [](const KnownLamp &lamp) { return lamp.place.y; };
    std::ranges::stable_sort(expected, {}, row);
    for (SeenLamp &seen : lamps_) {
        const KnownLamp &own = seen.lamp;
        if (seen.repaired || own.inverse_z != 0 || !is_small(seen.pixels)) continue;
        double nearest = WarpTuning::lamp_same_place, inverse_z = 0;
        auto other = std::ranges::lower_bound(expected, own.place.y - WarpTuning::lamp_same_place, {}, row);
        for (; other != expected.end() && other->place.y <= own.place.y + WarpTuning::lamp_same_place;
             ++other) {
            const double off = (other->place - own.place).length();
            if (!(off < nearest) || !is_same_light(*other, own)) continue;
            nearest = off;
            inverse_z = other->inverse_z;
        }
        if (!(inverse_z > seen.around + tolerance_)) continue;
        seen.repaired = true;
        for (const Imath::V2i &p : seen.pixels) move(p, inverse_z);
    }
}

} // namespace

std::vector<PartlyHiddenLamps> repair_lamp_depths(std::span<ViewSamples> views,
                                                  std::span<const ViewMapping> mappings, double tolerance) {
    std::vector<std::optional<LampsOfView>> found(views.size());
    parallel_for(views.size(), [&](std::size_t v) { found[v].emplace(views[v], tolerance); });
    std::vector<KnownLamp> known; // in the centre view
    for (std::size_t v = 0; v < views.size(); ++v)
        for (const SeenLamp &seen : found[v]->lamps()) {
            const KnownLamp &lamp = seen.lamp;
            if (lamp.inverse_z == 0) continue;
            known.push_back(lamp);
            known.back().place =
                mappings[v].at_infinity(lamp.place) + mappings[v].parallax(lamp.place) * lamp.inverse_z;
        }
    parallel_for(views.size(), [&](std::size_t v) {
        found[v]->repair_by_neighbours();
        found[v]->repair_by_others(mappings[v], known);
    });
    std::vector<PartlyHiddenLamps> crossed;
    std::vector<std::vector<LampBeforeWall>> unknown;
    for (const auto &view : found) {
        crossed.push_back(view->crossed());
        unknown.push_back(view->unknown());
    }
    const std::vector<KnownLamp> by_parallax = depths_by_parallax(unknown, mappings, tolerance);
    if (by_parallax.empty()) return crossed;
    parallel_for(views.size(), [&](std::size_t v) { found[v]->repair_by_others(mappings[v], by_parallax); });
    return crossed;
}

namespace {

class LampParallax {
public:
    LampParallax(std::span<const std::vector<LampBeforeWall>> lamps, std::span<const ViewMapping> mappings,
                 double tolerance)
        : lamps_(lamps), mappings_(mappings), tolerance_(tolerance) {}

    // The depth of lamp `seen` in view v; none if it may as well lie on its surroundings.
    std::optional<KnownLamp> before_its_wall(std::size_t v, const LampBeforeWall &seen) const {
        if (shown(in_centre(v, seen.lamp, seen.around)).parallax.size() > lamps_.size() / 2) return {};
        std::optional<KnownLamp> found;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t w = 0; w < lamps_.size(); ++w) {
            if (w == v) continue;
            for_each_near(w, seen.lamp.place.y, WarpTuning::lamp_farthest, [&](const KnownLamp &other) {
                if (!is_same_light(seen.lamp, other)) return;
                const Imath::V2d apart = mappings_[w].at_infinity(other.place) -
                                         mappings_[v].at_infinity(seen.lamp.place),
                                 step = mappings_[v].parallax(seen.lamp.place) -
                                        mappings_[w].parallax(other.place);
                const double inverse_z = apart.dot(step) / step.length2();
                if (!(inverse_z > seen.around + tolerance_) || apart.length() > WarpTuning::lamp_farthest)
                    return;
                if ((apart - step * inverse_z).length() >= WarpTuning::lamp_same_place) return;
                const Shown all = shown(in_centre(v, seen.lamp, inverse_z));
                if (all.parallax.size() < lamps_.size()) return;
                const auto [lamp, off] = best(seen.lamp, all);
                if (off >= least) return;
                least = off;
                found = lamp;
            });
        }
        return found;
    }

private:
    KnownLamp in_centre(std::size_t v, const KnownLamp &lamp, double inverse_z) const {
        KnownLamp moved = lamp;
        moved.place = mappings_[v].at_infinity(lamp.place) + mappings_[v].parallax(lamp.place) * inverse_z;
        moved.inverse_z = inverse_z;
        return moved;
    }
    template <typename Visit>
    void for_each_near(std::size_t v, double y, double reach, const Visit &visit) const {
        const auto row = [](const LampBeforeWall &of) { return of.lamp.place.y; };
        for (auto at = std::ranges::lower_bound(lamps_[v], y - reach, {}, row);
             at != lamps_[v].end() && row(*at) <= y + reach; ++at)
            visit(at->lamp);
    }
    // Where the views that show a lamp show it.
    struct Shown {
        std::vector<Imath::V2d> at_infinity, parallax; // in the centre view
    };
    Shown shown(const KnownLamp &lamp) const {
        Shown found;
        for (std::size_t v = 0; v < lamps_.size(); ++v) {
            const Imath::V2d at = mappings_[v].in_view(lamp.place, lamp.inverse_z);
            double nearest = WarpTuning::lamp_same_place;
            const KnownLamp *seen = nullptr;
            for_each_near(v, at.y, WarpTuning::lamp_same_place, [&](const KnownLamp &other) {
                const double off = (other.place - at).length();
                if (!(off < nearest) || !is_same_light(lamp, other)) return;
                nearest = off;
                seen = &other;
            });
            if (!seen) continue;
            found.at_infinity.push_back(mappings_[v].at_infinity(seen->place));
            found.parallax.push_back(mappings_[v].parallax(seen->place));
        }
        return found;
    }
    // Returns the lamp that agrees best with where views show it, because a view knows positions to a pixel or so; and
    // by how much it does not agree.
    static std::pair<KnownLamp, double> best(KnownLamp lamp, const Shown &shown) {
        const auto mean = [](const std::vector<Imath::V2d> &of) {
            return std::accumulate(of.begin(), of.end(), Imath::V2d(0)) / double(of.size());
        };
        const Imath::V2d a = mean(shown.at_infinity), p = mean(shown.parallax);
        double sum = 0, total = 0;
        for (std::size_t i = 0; i < shown.parallax.size(); ++i) {
            sum -= (shown.at_infinity[i] - a).dot(shown.parallax[i] - p);
            total += (shown.parallax[i] - p).length2();
        }
        lamp.inverse_z = sum / total;
        lamp.place = a + p * lamp.inverse_z;
        double off = 0;
        for (std::size_t i = 0; i < shown.parallax.size(); ++i)
            off += (shown.at_infinity[i] + shown.parallax[i] * lamp.inverse_z - lamp.place).length2();
        return {lamp, off};
    }

    std::span<const std::vector<LampBeforeWall>> lamps_; // [view], by rows
    std::span<const ViewMapping> mappings_;
    double tolerance_;
};

} // namespace

std::vector<KnownLamp> depths_by_parallax(std::span<const std::vector<LampBeforeWall>> lamps,
                                          std::span<const ViewMapping> mappings, double tolerance) {
    std::vector<KnownLamp> known;
    if (lamps.size() < WarpTuning::lamp_least_views) return known;
    if (std::ranges::any_of(lamps,
                            [](const auto &of_view) { return of_view.size() > WarpTuning::most_lamps; }))
        return known;
    const LampParallax parallax(lamps, mappings, tolerance);
    for (std::size_t v = 0; v < lamps.size(); ++v)
        for (const LampBeforeWall &seen : lamps[v])
            if (const auto lamp = parallax.before_its_wall(v, seen)) known.push_back(*lamp);
    return known;
}

} // namespace sparselens
