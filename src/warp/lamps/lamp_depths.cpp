#include "warp/lamps/lamp_depths.h"

#include "base/parallel.h"
#include "warp/lamps/compact_lamps.h"
#include "warp/lamps/lamp_parallax.h"
#include "warp/lamps/pixel_light.h"
#include "warp/tuning.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace sparselens {

namespace {

// A lamp of a view.
struct SeenLamp {
    KnownLamp lamp;          // inverse_z is 0 if all its pixels have depths that occur around it
    double around = 0;       // 1 / z of the nearest thing around; behind a lamp of known depth
    bool is_crossed = false; // whether something around is in front of it
    std::vector<Imath::V2i> all;
    std::vector<Imath::V2i> pixels; // those whose light belongs at the lamp's depth
    std::vector<Imath::V2i> at_its_depth;
    bool settled = false; // by other views
};

bool is_small(std::span<const Imath::V2i> pixels) {
    Imath::Box2i box;
    for (const Imath::V2i &p : pixels) box.extendBy(p);
    return box.size().x < WarpTuning::small_lamp && box.size().y < WarpTuning::small_lamp;
}

double inverse_z_at(const ViewSamples &view, const Imath::V2i &p) {
    const SampleRange shown = view.pixel(view.windows.index(p.x, p.y));
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
    void settle_by_neighbours();
    // The pixels of lamps that something crosses, ascending.
    std::vector<std::size_t> crossed() const;
    // The lamps whose depth is not known, by rows.
    std::vector<LampBeforeWall> unknown() const;
    // Settles lamps by others whose positions are in the centre view.
    void settle_by_others(const ViewMapping &mapping, std::span<const KnownLamp> others);

private:
    SeenLamp look_at(const CompactLamp &found, std::span<const double> around) const;
    double depth_of(const CompactLamp &found, std::span<const double> around) const;
    double light_at(const Imath::V2i &p) const { return light_.at(view_.windows.index(p.x, p.y)); }
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
    const SampleRange shown = view_.pixel(view_.windows.index(pixel.x, pixel.y));
    if (!shown.empty()) view_.set_z(shown.front(), float(1 / inverse_z));
}

void LampsOfView::settle_by_neighbours() {
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
            for (const Imath::V2i &p : seen.all) pixels.push_back(view_.windows.index(p.x, p.y));
    std::ranges::sort(pixels);
    return pixels;
}

std::vector<LampBeforeWall> LampsOfView::unknown() const {
    std::vector<LampBeforeWall> found;
    for (const SeenLamp &seen : lamps_)
        if (!seen.settled && seen.lamp.inverse_z == 0 && is_small(seen.pixels))
            found.push_back({seen.lamp, seen.around});
    std::ranges::stable_sort(found, {}, [](const LampBeforeWall &of) { return of.lamp.place.y; });
    return found;
}

void LampsOfView::settle_by_others(const ViewMapping &mapping, std::span<const KnownLamp> others) {
    std::vector<KnownLamp> expected(others.begin(), others.end());
    for (KnownLamp &lamp : expected) lamp.place = mapping.in_view(lamp.place, lamp.inverse_z);
    std::erase_if(expected, [](const KnownLamp &lamp) { return !std::isfinite(lamp.place.y); });
    const auto row = [](const KnownLamp &lamp) { return lamp.place.y; };
    std::ranges::stable_sort(expected, {}, row);
    for (SeenLamp &seen : lamps_) {
        const KnownLamp &own = seen.lamp;
        if (seen.settled || own.inverse_z != 0 || !is_small(seen.pixels)) continue;
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
        seen.settled = true;
        for (const Imath::V2i &p : seen.pixels) move(p, inverse_z);
    }
}

} // namespace

std::vector<CrossedLamps> settle_lamp_depths(std::span<ViewSamples> views,
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
        found[v]->settle_by_neighbours();
        found[v]->settle_by_others(mappings[v], known);
    });
    std::vector<CrossedLamps> crossed;
    std::vector<std::vector<LampBeforeWall>> unknown;
    for (const auto &view : found) {
        crossed.push_back(view->crossed());
        unknown.push_back(view->unknown());
    }
    const std::vector<KnownLamp> by_parallax = depths_by_parallax(unknown, mappings, tolerance);
    if (by_parallax.empty()) return crossed;
    parallel_for(views.size(), [&](std::size_t v) { found[v]->settle_by_others(mappings[v], by_parallax); });
    return crossed;
}

} // namespace sparselens
