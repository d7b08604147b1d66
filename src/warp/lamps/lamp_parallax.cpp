#include "warp/lamps/lamp_parallax.h"

#include "warp/tuning.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

namespace sparselens {

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
