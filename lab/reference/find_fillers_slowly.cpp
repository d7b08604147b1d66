#include "lab/reference/find_fillers_slowly.h"

#include "deep/build.h"
#include "deep/mixed_pixels.h"
#include "dof/tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace sparselens {

namespace {

// The last thing in a pixel.
struct Ground {
    Imath::V2i pixel;
    double depth;                        // disparity
    std::optional<std::uint64_t> sample; // empty: nothing
};
using Found = std::optional<Ground>;

// A ground that continues from `distance` pixels away, and what it shows.
struct Side {
    int distance;
    Ground ground, shown;
    Imath::V2i on; // the direction
};

class SlowFillers {
public:
    SlowFillers(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &known)
        : ldi_(ldi), lens_(lens), known_(known) {}

    std::vector<Filler> at(const Imath::V2i &pixel) const {
        std::vector<Filler> fillers;
        std::vector<Side> sides = sides_at(pixel, nearest_of);
        if (sides.empty()) return fillers;
        const Side first = fill(pixel, sides, fillers);
        sides = sides_at(pixel, farthest_of);
        std::erase_if(sides, [&](const Side &side) {
            return first.ground.depth - side.ground.depth <= one_surface_px;
        });
        if (!sides.empty()) fill(pixel, sides, fillers);
        return fillers;
    }

private:
    using Chosen = Side (*)(const std::vector<Side> &);

    static Side nearest_of(const std::vector<Side> &sides) { return sides.front(); }
    static Side farthest_of(const std::vector<Side> &sides) {
        return *std::ranges::min_element(sides, {}, [](const Side &side) { return side.ground.depth; });
    }

    // One of the grounds that reach the pixel, for each direction.
    std::vector<Side> sides_at(const Imath::V2i &pixel, Chosen choose) const {
        std::vector<Side> chosen;
        for (const Imath::V2i &on : {Imath::V2i(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
            const std::vector<Side> sides = sides_along(pixel, on);
            if (!sides.empty()) chosen.push_back(choose(sides));
        }
        return chosen;
    }

    // Adds the filler of these sides, and returns the side that decides.
    Side fill(const Imath::V2i &pixel, const std::vector<Side> &sides, std::vector<Filler> &fillers) const {
        const Side first = *std::ranges::min_element(sides, fills_before);
        if (first.ground.sample && holds(pixel, first.ground.depth)) return first;
        Filler filler{std::uint32_t(ldi_.windows.index(pixel)), z_of(first.ground), 0, {}, false};
        double weights = 0;
        for (const Side &side : sides) {
            if (side.ground.sample.has_value() != first.ground.sample.has_value()) continue;
            if (std::abs(side.ground.depth - first.ground.depth) >= one_surface_px) continue;
            const double weight = 1.0 / side.distance;
            filler.part[filler.count++] = {
                side.shown.sample ? std::uint32_t(*side.shown.sample) : Filler::nothing,
                std::uint32_t(ldi_.windows.index(side.shown.pixel)), float(weight / coverage(side.shown))};
            weights += weight;
            for (const Side &other : sides)
                filler.is_between |= first.ground.sample && other.on == -side.on && other.ground.sample &&
                                     std::abs(other.ground.depth - first.ground.depth) < one_surface_px;
        }
        for (Filler::Part &part : filler.part) part.share /= float(weights);
        fillers.push_back(filler);
        return first;
    }

    bool holds(const Imath::V2i &pixel, double depth) const {
        for (const std::uint64_t i : ldi_.pixel(ldi_.windows.index(pixel)))
            if (std::abs(disparity(lens_, double(ldi_.z[i])) - depth) < one_surface_px) return true;
        return false;
    }
    static bool fills_before(const Side &a, const Side &b) {
        if (a.distance != b.distance) return a.distance < b.distance;
        return a.ground.depth != b.ground.depth ? a.ground.depth < b.ground.depth
                                                : a.ground.sample.has_value() && !b.ground.sample.has_value();
    }
    float z_of(const Ground &ground) const {
        return ground.sample ? ldi_.z[*ground.sample] : std::numeric_limits<float>::infinity();
    }
    double coverage(const Ground &ground) const {
        return ground.sample ? double(alpha_at(ldi_, ldi_.alpha(), *ground.sample)) : 1;
    }

    Found ground(const Imath::V2i &pixel) const {
        if (!ldi_.windows.data.intersects(pixel)) return {};
        double left = 1;
        Found last;
        for (const std::uint64_t i : ldi_.pixel(ldi_.windows.index(pixel))) {
            const double alpha = std::clamp(double(alpha_at(ldi_, ldi_.alpha(), i)), 0.0, 1.0);
            left *= 1 - alpha;
            if (alpha >= 0.5) last = Ground{pixel, disparity(lens_, double(ldi_.z[i])), i};
        }
        if (left < 1.0 / 2048) return last;
        return known_.intersects(pixel) ? Found(Ground{pixel, 0, {}}) : Found();
    }

    // Whether each pixel up to n on hides the ground, as it must where the ground continues.
    bool reaches(const Ground &from, const Imath::V2i &on, int n) const {
        for (int m = 1; m <= n; ++m) {
            const Found other = ground(from.pixel + m * on);
            if (!other) return false;
            const double nearer = other->depth - from.depth;
            if (nearer <= one_surface_px || m - 1 >= std::sqrt(2.0) * nearer) return false;
        }
        return true;
    }

    // The grounds that reach the pixel, the one with the nearest end first.
    std::vector<Side> sides_along(const Imath::V2i &pixel, const Imath::V2i &on) const {
        std::vector<Side> sides;
        for (int n = 1; ldi_.windows.data.intersects(pixel - n * on); ++n) {
            const Found from = ground(pixel - n * on);
            if (from && reaches(*from, on, n)) sides.push_back({n, *from, shown_by(*from, on), on});
        }
        return sides;
    }

    // If the last sample's colour is a mixture with what hides it, the ground one pixel before it; else the last
    // ground.
    Ground shown_by(const Ground &last, const Imath::V2i &on) const {
        const Found before = ground(last.pixel - on), hides = ground(last.pixel + on);
        if (!before || !hides || !last.sample || !before->sample || !hides->sample) return last;
        if (ldi_.pixel(ldi_.windows.index(last.pixel)).size() != 1) return last;
        if (std::abs(before->depth - last.depth) >= one_surface_px) return last;
        const auto mixture = colour(last), strange = colour(*hides), own = colour(*before);
        if (!mixture || !unmix(*mixture, *strange, *own, mostly_b, GatherTuning::filler_mixed)) return last;
        return *before;
    }

    // Empty if there are no R, G and B.
    std::optional<Imath::V3d> colour(const Ground &of) const {
        Imath::V3d colour;
        for (const int k : {0, 1, 2}) {
            const std::size_t channel = find_channel(ldi_.channels, std::string(1, "RGB"[k]));
            if (channel == npos) return {};
            colour[k] = double(ldi_.values[channel][*of.sample]) / coverage(of);
        }
        return colour;
    }

    const Ldi &ldi_;
    const ThinLens &lens_;
    Imath::Box2i known_;
};

} // namespace

std::vector<Filler> find_fillers_slowly(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &known) {
    const SlowFillers slow(ldi, lens, known);
    std::vector<Filler> fillers;
    for (std::size_t i = 0; i < ldi.windows.pixels(); ++i)
        for (const Filler &filler : slow.at(ldi.windows.pixel(i))) fillers.push_back(filler);
    return fillers;
}

} // namespace sparselens
