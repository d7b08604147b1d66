#include "warp/silhouettes.h"

#include "base/parallel.h"
#include "deep/build.h"
#include "lens/perceptive_depth.h"
#include "warp/unmixing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace sparselens {

namespace {

constexpr int radius = 2;                // pixels around that tell what a surface shows
constexpr double edge_share = 0.1;       // how much a pixel that may be mixed itself tells of its surface
constexpr double least_support = 0.01;   // below this nothing is known of a surface
constexpr double largest_residual = 0.2; // distance of c from the line, as a share of the contrast
constexpr double largest_residual_of_one = 0.1; // where B is one pixel, not a mean
constexpr double least_share_of_one = 0.1;      // and less of either may as well be texture

// What a surface shows around a pixel: a mean over samples.
struct Estimate {
    std::vector<Term> terms; // coefficients sum to 1
    Imath::V3d colour{0, 0, 0};
    bool pure = false; // some of them are pixels that nothing else is mixed into
};

struct Mixture {
    double near_depth, far_depth; // perceptive
    double share;                 // of the nearer surface
    Estimate behind;
};

class Separation {
public:
    Separation(const Ldi &view, double scale, double jump);
    void emit_pixel(std::size_t pixel, Ldi &out) const;

private:
    enum Side : unsigned char { inside = 0, has_nearer = 1, has_farther = 2 };

    unsigned char side_of(int x, int y) const;
    std::optional<Mixture> mixture_of(int x, int y) const;
    std::optional<Estimate> estimate(int x, int y, double depth) const;
    Imath::V3d purest(int x, int y, double depth, const Imath::V3d &front, const Imath::V3d &behind) const;
    std::optional<Mixture> with_one_pixel(int x, int y, double near_depth, const Imath::V3d &front) const;
    void emit_mixture(std::uint64_t i, const Mixture &mixture, Ldi &out) const;

    // visit(sample, dx, dy) for the samples of the pixels within `reach` of (x, y).
    template <typename Visit>
    void around(int x, int y, int reach, const Visit &visit) const;

    std::uint64_t own_sample(int x, int y) const { return view_.pixel(grid_.index(x, y)).front(); }
    bool is_empty(std::size_t pixel) const { return view_.pixel(pixel).empty(); }
    double depth_of(std::uint64_t i) const { return depths_[i]; }
    bool is_opaque(std::uint64_t i) const { return alpha_at(view_, alpha_, i) >= 1; }
    // Whether it is of the surface at that depth, and nothing nearer may be mixed into it.
    bool tells_of(double depth, std::uint64_t i) const {
        return !(std::abs(depth_of(i) - depth) >= jump_ || (sides_[i] & has_nearer)) && is_opaque(i);
    }
    Imath::V3d colour_of(std::uint64_t i) const {
        const auto value = [&](std::size_t k) { return double(view_.values[rgb_[k]][i]); };
        return {value(0), value(1), value(2)};
    }

    const Ldi &view_;
    Grid grid_; // of its window, from its corner
    double scale_, jump_;
    std::size_t alpha_;
    std::array<std::size_t, 3> rgb_;
    std::vector<double> depths_;       // of each sample, perceptive
    std::vector<unsigned char> sides_; // of the first sample of each pixel
};

Separation::Separation(const Ldi &view, double scale, double jump)
    : view_(view), grid_(view.windows.width(), view.windows.height()), scale_(scale), jump_(jump),
      alpha_(view.alpha()), rgb_(find_rgb(view.channels)) {
    depths_.resize(view.samples());
    std::ranges::transform(view.z, depths_.begin(),
                           [scale](float z) { return perceptive_depth(scale, double(z)); });
    sides_.assign(view.samples(), inside);
    if (alpha_ == npos || !all_found(rgb_)) return;
    parallel_for(std::size_t(grid_.height()), [&](std::size_t y) {
        for (int x = 0; x < grid_.width(); ++x)
            if (const std::size_t pixel = grid_.index(x, int(y)); !is_empty(pixel))
                sides_[view_.pixel(pixel).front()] = side_of(x, int(y));
    });
}

unsigned char Separation::side_of(int x, int y) const {
    const double own = depth_of(own_sample(x, y));
    unsigned char side = inside;
    around(x, y, 1, [&](std::uint64_t i, int, int) {
        if (depth_of(i) > own + jump_) side |= has_nearer;
        if (depth_of(i) < own - jump_) side |= has_farther;
    });
    return side;
}

template <typename Visit>
void Separation::around(int x, int y, int reach, const Visit &visit) const {
    for (int v = std::max(y - reach, 0); v <= std::min(y + reach, grid_.height() - 1); ++v)
        for (int u = std::max(x - reach, 0); u <= std::min(x + reach, grid_.width() - 1); ++u) {
            const std::size_t pixel = grid_.index(u, v);
            if (!is_empty(pixel)) visit(view_.pixel(pixel).front(), u - x, v - y);
        }
}

// By the square of the distance in pixels.
const auto nearness = [] {
    std::array<double, 2 * radius * radius + 1> table{};
    for (std::size_t d2 = 0; d2 < table.size(); ++d2) table[d2] = std::exp(-0.5 * double(d2));
    return table;
}();

// The mean of the surface at that depth over the pixels around that nothing nearer may be mixed into; those that
// something farther may be mixed into count less: a lamp behind it would shine at its depth.
std::optional<Estimate> Separation::estimate(int x, int y, double depth) const {
    Estimate result;
    result.terms.reserve((2 * radius + 1) * (2 * radius + 1));
    double sum = 0;
    around(x, y, radius, [&](std::uint64_t i, int dx, int dy) {
        if (!tells_of(depth, i)) return;
        const double weight =
            nearness[std::size_t(dx * dx + dy * dy)] * (sides_[i] & has_farther ? edge_share : 1);
        result.terms.push_back({i, weight});
        result.pure = result.pure || !(sides_[i] & has_farther);
        sum += weight;
    });
    if (sum < least_support) return {};
    for (Term &term : result.terms) {
        term.coefficient /= sum;
        result.colour += term.coefficient * colour_of(term.index);
    }
    return result;
}

std::optional<Mixture> Separation::mixture_of(int x, int y) const {
    const std::uint64_t own = own_sample(x, y);
    const bool own_is_far = sides_[own] & has_nearer;
    Mixture mixture{depth_of(own), depth_of(own), 0, {}};
    double nearest = 3; // of the farther pixels around; those at the edges before those at the corners
    around(x, y, 1, [&](std::uint64_t i, int dx, int dy) {
        const double depth = depth_of(i);
        if (own_is_far) mixture.near_depth = std::max(mixture.near_depth, depth);
        if (own_is_far || depth >= depth_of(own) - jump_) return;
        const int distance = dx * dx + dy * dy;
        if (distance < nearest || (distance == nearest && depth > mixture.far_depth))
            mixture.far_depth = depth;
        nearest = std::min(nearest, double(distance));
    });
    const auto front = estimate(x, y, mixture.near_depth), behind = estimate(x, y, mixture.far_depth);
    if (!front) return {};
    if (!behind) return with_one_pixel(x, y, mixture.near_depth, front->colour);
    const Imath::V3d f =
        front->pure ? front->colour : purest(x, y, mixture.near_depth, front->colour, behind->colour);
    const auto mix = unmix(colour_of(own), f, behind->colour, own_is_far, largest_residual);
    if (!mix) return with_one_pixel(x, y, mixture.near_depth, f);
    mixture.share = mix->share;
    mixture.behind = *behind;
    return mixture;
}

// Of the pixels of a surface that shows none without an edge, as a wire or a small lamp, the one least mixed: that
// which differs most from what is behind.
Imath::V3d Separation::purest(int x, int y, double depth, const Imath::V3d &front,
                              const Imath::V3d &behind) const {
    const Imath::V3d contrast = front - behind;
    Imath::V3d result = front;
    around(x, y, 1, [&](std::uint64_t i, int, int) {
        if (!tells_of(depth, i)) return;
        if (const Imath::V3d c = colour_of(i); (c - result).dot(contrast) > 0) result = c;
    });
    return result;
}

// What lies behind may be smaller than what a mean looks at: a lamp, a stripe. Then it is the one of the farther
// pixels around that the colour fits best.
std::optional<Mixture> Separation::with_one_pixel(int x, int y, double near_depth,
                                                  const Imath::V3d &front) const {
    const std::uint64_t own = own_sample(x, y);
    const bool own_is_far = sides_[own] & has_nearer;
    std::optional<Mixture> best;
    double least = std::numeric_limits<double>::infinity();
    around(x, y, 1, [&](std::uint64_t i, int, int) {
        if (i == own || depth_of(i) >= near_depth - jump_ || !is_opaque(i)) return;
        const Imath::V3d b = colour_of(i);
        const auto mix = unmix(colour_of(own), front, b, own_is_far, largest_residual_of_one);
        if (!mix || mix->residual >= least) return;
        if (std::min(mix->share, 1 - mix->share) < least_share_of_one) return;
        least = mix->residual;
        best = {near_depth, depth_of(i), mix->share, {{{i, 1}}, b}};
    });
    return best;
}

void Separation::emit_mixture(std::uint64_t i, const Mixture &mixture, Ldi &out) const {
    std::vector<Term> front{{i, 1}};
    for (const Term &term : mixture.behind.terms)
        front.push_back({term.index, -(1 - mixture.share) * term.coefficient});
    MergedSample sample = sample_at(view_, i);
    sample.z = sample.z_back = float(depth_of_perceptive(scale_, mixture.near_depth));
    sample.terms = front;
    append(out, view_, sample);
    sample.z = sample.z_back = float(depth_of_perceptive(scale_, mixture.far_depth));
    sample.weight = estimate_weight;
    sample.terms = mixture.behind.terms;
    append(out, view_, sample);
}

void Separation::emit_pixel(std::size_t pixel, Ldi &out) const {
    if (is_empty(pixel)) return;
    const std::uint64_t own = view_.pixel(pixel).front();
    if (sides_[own] != inside && is_opaque(own)) {
        const Imath::V2i at = grid_.pixel(pixel);
        if (const auto mixture = mixture_of(at.x, at.y)) return emit_mixture(own, *mixture, out);
    }
    append(out, view_, own);
}

} // namespace

Ldi separate_silhouettes(const Ldi &view, double scale, double jump) {
    const Separation separation(view, scale, jump);
    return build_by_pixels(view, [&](std::size_t pixel, Ldi &out) { separation.emit_pixel(pixel, out); });
}

} // namespace sparselens
