#include "lab/reference/find_facets_slowly.h"

#include "deep/build.h"
#include "dof/facets/facets.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sparselens {

namespace {

// An opaque sample, its pixel, and its disparity. The depth is a float, as where samples are sorted, so that
// equal depths are equal in both places.
struct Opaque {
    Imath::V2i pixel;
    std::uint64_t sample;
    float depth;
};
using Found = std::optional<Opaque>;

class SlowFacets {
public:
    SlowFacets(const Ldi &ldi, const ThinLens &lens, double steep) : ldi_(ldi), lens_(lens), steep_(steep) {}

    std::vector<Opaque> opaque_in(const Imath::V2i &pixel) const {
        std::vector<Opaque> found;
        if (!ldi_.windows.data.intersects(pixel)) return found;
        for (const std::uint64_t i : ldi_.pixel(ldi_.windows.index(pixel)))
            if (alpha_at(ldi_, ldi_.alpha(), i) >= 0.9995f)
                found.push_back({pixel, i, float(disparity(lens_, 1)) / ldi_.z[i]});
        return found;
    }

    // Adds facets with a corner in this sample's pixel, which is the upper left one of four.
    void add_facets(const Opaque &a, std::vector<std::array<std::uint64_t, 3>> &facets) const {
        const Imath::V2i right(1, 0), down(0, 1);
        const Found b = linked(a, right), c = linked(a, down);
        const Found d_by_b = b ? linked(*b, down) : Found(), d_by_c = c ? linked(*c, right) : Found();
        const bool closed = d_by_b && d_by_c && d_by_b->sample == d_by_c->sample;
        const auto add = [&](const Found &second, const Found &third) {
            if (!second || !third) return;
            const auto [least, most] = std::minmax({a.depth, second->depth, third->depth});
            if (double(most) - double(least) >= steep_)
                facets.push_back({a.sample, second->sample, third->sample});
        };
        add(b, d_by_b);
        add(c, d_by_c);
        if (!closed) add(b, c);
    }

    // The sample that `a` is linked to in the pixel one step on.
    Found linked(const Opaque &a, const Imath::V2i &step) const {
        const Found b = nearest(a.pixel + step, double(a.depth));
        if (!b) return {};
        const double d = double(b->depth) - double(a.depth);
        if (std::abs(d) < double(steep_px)) return b;
        // Five steps in a line; the middle one goes from a to b. The steps before it are followed backwards, where a
        // rise is a fall.
        const auto after = next_steps(*b, step, d), before = next_steps(a, Imath::V2i(0) - step, -d);
        const double line[] = {-before[1], -before[0], d, after[0], after[1]};
        double s = 0;
        for (int first = 0; first <= 2; ++first) {
            double smaller = INFINITY; // of the other two of these three steps
            for (int k = first; k < first + 3; ++k)
                if (k != 2) smaller = std::min(smaller, std::abs(line[k]));
            s = std::max(s, smaller);
        }
        return std::abs(d) < double(steep_px) + 2 * s ? b : Found();
    }

private:
    Found nearest(const Imath::V2i &pixel, double depth) const {
        Found nearest;
        for (const Opaque &s : opaque_in(pixel))
            if (!nearest || std::abs(double(s.depth) - depth) < std::abs(double(nearest->depth) - depth))
                nearest = s;
        return nearest;
    }

    // Steps of depth from pixel to pixel, each searched at the depth to which the last one leads; 0 from where a step
    // has the other sign or is missing, or if the first sample goes on level.
    std::array<double, 2> next_steps(Opaque from, const Imath::V2i &step, double last) const {
        std::array<double, 2> steps{0, 0};
        const Found level = nearest(from.pixel + step, double(from.depth));
        if (level && std::abs(level->depth - from.depth) < steep_px) return steps;
        for (double &s : steps) {
            const Found next = nearest(from.pixel + step, double(from.depth) + last);
            if (!next) break;
            const double difference = double(next->depth) - double(from.depth);
            if (difference * last <= 0) break;
            last = s = difference;
            from = *next;
        }
        return steps;
    }

    const Ldi &ldi_;
    const ThinLens &lens_;
    double steep_;
};

} // namespace

std::vector<std::array<std::uint64_t, 3>> find_facets_slowly(const Ldi &ldi, const ThinLens &lens,
                                                             double widest) {
    const SlowFacets slow(ldi, lens, double(steep_px) / widest);
    std::vector<std::array<std::uint64_t, 3>> facets;
    const Imath::Box2i &data = ldi.windows.data;
    for (int y = data.min.y; y < data.max.y; ++y)
        for (int x = data.min.x; x < data.max.x; ++x)
            for (const Opaque &a : slow.opaque_in({x, y})) slow.add_facets(a, facets);
    return facets;
}

std::optional<std::uint64_t> linked_slowly(const Ldi &ldi, const ThinLens &lens, std::uint64_t sample,
                                           const Imath::V2i &pixel, const Imath::V2i &step) {
    const SlowFacets slow(ldi, lens, 0);
    for (const Opaque &own : slow.opaque_in(pixel))
        if (own.sample == sample)
            if (const Found found = slow.linked(own, step)) return found->sample;
    return {};
}

} // namespace sparselens
