#include "lab/reference/lamps_slowly.h"

#include "base/light.h"
#include "base/parallel.h"
#include "deep/build.h"
#include "lab/reference/find_facets_slowly.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace sparselens {

namespace {

constexpr double torn = 1; // pixels of disparity: surfaces farther apart are separate

struct Edge {
    double place, coc;
    double seen(double u) const { return place + coc * u; }
};

// A sample as the lens sees it.
struct Seen {
    Imath::V2i pixel;
    Imath::V2d place;
    double coc;   // displacement where it hides
    double shine; // displacement of its light
    double depth; // disparity, pixels
    double alpha;
    Edge left, right, above, below;
    bool shows_image() const { return shine != coc; }
};

using Samples = std::vector<Seen>; // in the order of the LDI

Samples place(const Ldi &ldi, const ThinLens &lens) {
    Samples samples;
    for (std::size_t p = 0; p < ldi.windows.pixels(); ++p)
        for (const std::uint64_t i : ldi.pixel(p)) {
            const float alpha = alpha_at(ldi, ldi.alpha(), i);
            const Imath::V2i pixel = ldi.windows.pixel(p);
            const Imath::V2d offset(ldi.dx.empty() ? 0 : double(ldi.dx[i]),
                                    ldi.dy.empty() ? 0 : double(ldi.dy[i]));
            const double z = double(ldi.z[i]), shine = circle_of_confusion(lens, ldi.coc_z(i));
            samples.push_back({pixel,
                               Imath::V2d(pixel) + Imath::V2d(0.5) + offset,
                               is_opaque(alpha) ? circle_of_confusion(lens, z) : shine,
                               shine,
                               disparity(lens, z),
                               is_opaque(alpha) ? 1 : double(alpha),
                               {},
                               {},
                               {},
                               {}});
        }
    return samples;
}

// The sample of that pixel on one surface with `own`; null if there is none.
const Seen *neighbour(const Samples &samples, const Seen &own, const Imath::V2i &pixel) {
    const Seen *found = nullptr;
    double least = torn;
    for (const Seen &other : samples) {
        const double apart = std::abs(other.depth - own.depth);
        if (other.pixel != pixel || apart >= least) continue;
        found = &other;
        least = apart;
    }
    return found;
}

void find_edges(const Ldi &ldi, const ThinLens &lens, const Samples &samples, std::size_t i, Seen &own) {
    const auto edge = [&](const Imath::V2i &beside) {
        const int axis = beside.x != 0 ? 0 : 1;
        const auto linked = linked_slowly(ldi, lens, i, own.pixel, beside);
        const Seen *other = linked ? &samples[*linked] : neighbour(samples, own, own.pixel + beside);
        const Edge alone{own.place[axis] + 0.5 * (beside.x + beside.y), own.coc};
        if (!other) return alone;
        const Edge shared{(own.place[axis] + other->place[axis]) / 2, (own.coc + other->coc) / 2};
        const double loose = linked ? 0 : std::max(0.0, (std::abs(other->depth - own.depth) - 0.75) / 0.25);
        return Edge{std::lerp(shared.place, alone.place, loose), std::lerp(shared.coc, alone.coc, loose)};
    };
    own.left = edge({-1, 0});
    own.right = edge({1, 0});
    own.above = edge({0, -1});
    own.below = edge({0, 1});
}

// `u`: a lens point, in pixels per pixel of CoC: y down, times the pixel aspect.
bool covers(const Seen &s, const Imath::V2d &u, const Imath::V2d &q) {
    return s.left.seen(u.x) <= q.x && q.x < s.right.seen(u.x) && s.above.seen(u.y) <= q.y &&
           q.y < s.below.seen(u.y);
}

class Lights {
public:
    Lights(const Ldi &ldi, const ThinLens &lens, std::span<const SlowLamp> lamps)
        : lamps_(lamps), aspect_(lens.pixel_aspect), samples_(place(ldi, lens)) {
        for (const SlowLamp &lamp : lamps) shining_.insert(lamp.sample);
        parallel_for(samples_.size(), [&](std::size_t i) {
            Seen own = samples_[i];
            find_edges(ldi, lens, samples_, i, own);
            samples_[i].left = own.left, samples_[i].right = own.right;
            samples_[i].above = own.above, samples_[i].below = own.below;
        });
    }

    SlowlyLit at(const Imath::V2i &pixel, int side) const {
        SlowlyLit sum;
        for (const SlowLamp &lamp : lamps_) {
            const double c = samples_[lamp.sample].shine, square = std::clamp(2 - std::abs(c), 0.0, 1.0);
            square > 0 ? add_from_square(sum, lamp, square, pixel, side)
                       : add_from_place(sum, lamp, pixel, side);
        }
        return sum;
    }

private:
    void add_from_place(SlowlyLit &sum, const SlowLamp &lamp, const Imath::V2i &pixel, int side) const {
        const double c = samples_[lamp.sample].shine;
        const double share = 1 / (std::numbers::pi * c * c * aspect_ * side * side); // of one point
        for (int row = 0; row < side; ++row)
            for (int column = 0; column < side; ++column) {
                const Imath::V2d q = Imath::V2d(pixel) + Imath::V2d(column + 0.5, row + 0.5) / side;
                const auto u = lens_point(lamp, q);
                if (u.x * u.x + u.y * u.y / (aspect_ * aspect_) > 1) continue;
                add(sum, lamp, share, passed(lamp, u, q));
            }
    }

    // Adds the light over points of the lens, weighted by the share of the square that each sees inside the pixel.
    void add_from_square(SlowlyLit &sum, const SlowLamp &lamp, double square, const Imath::V2i &pixel,
                         int side) const {
        const int places = 8 * side;
        const auto inside = [&](double at, int low) {
            return std::max(0.0,
                            std::min(at + square / 2, low + 1.0) - std::max(at - square / 2, double(low))) /
                   square;
        };
        for (int row = 0; row < places; ++row)
            for (int column = 0; column < places; ++column) {
                Imath::V2d u = Imath::V2d(column + 0.5, row + 0.5) * 2.0 / places - Imath::V2d(1);
                if (u.x * u.x + u.y * u.y > 1) continue;
                u.y *= aspect_;
                const Imath::V2d q = samples_[lamp.sample].place + samples_[lamp.sample].shine * u;
                const double share =
                    inside(q.x, pixel.x) * inside(q.y, pixel.y) * 4 / (std::numbers::pi * places * places);
                if (share > 0) add(sum, lamp, share, passed(lamp, u, q));
            }
    }

    static void add(SlowlyLit &sum, const SlowLamp &lamp, double share, double left) {
        for (std::size_t k = 0; k < 3; ++k) sum.light[k] += share * left * lamp.light[k];
        sum.unhidden += share * lamp.light[0];
    }

    Imath::V2d lens_point(const SlowLamp &lamp, const Imath::V2d &q) const {
        return (q - samples_[lamp.sample].place) / samples_[lamp.sample].shine;
    }

    // The share of the lamp's light that passes through lens point u to q.
    double passed(const SlowLamp &lamp, const Imath::V2d &u, const Imath::V2d &q) const {
        double left = 1;
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            const Seen &s = samples_[i];
            if (!(s.depth > samples_[lamp.sample].depth) || !covers(s, u, q)) continue;
            const Seen &of = samples_[lamp.sample];
            if (s.alpha < 1 && s.pixel != of.pixel && s.depth <= 1.1 * of.depth && shining_.contains(i))
                continue;
            if (s.shows_image() && of.shows_image() && s.depth - of.depth < 1) continue; // of one mirror
            left *= 1 - s.alpha;
        }
        return left;
    }

    std::span<const SlowLamp> lamps_;
    double aspect_;
    Samples samples_;
    std::set<std::uint64_t> shining_;
};

} // namespace

std::vector<SlowlyLit> lamps_slowly(const Ldi &ldi, const ThinLens &lens, std::span<const SlowLamp> lamps,
                                    int side) {
    const Lights lights(ldi, lens, lamps);
    std::vector<SlowlyLit> lit(ldi.windows.pixels());
    parallel_for(lit.size(), [&](std::size_t p) { lit[p] = lights.at(ldi.windows.pixel(p), side); });
    return lit;
}

} // namespace sparselens
