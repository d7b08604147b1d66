#include "ldi/silhouettes.h"

#include "base/parallel.h"
#include "ldi/build.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace sparselens {

namespace {

constexpr int radius = 2;          // pixels around that tell what a surface shows
constexpr double edge_share = 0.1; // how much a pixel that may be mixed itself tells of the nearer surface
constexpr double least_support = 0.01;   // below this nothing is known of a surface
constexpr double least_contrast = 0.1;   // between F and B, as a share of their own size
constexpr double largest_residual = 0.2; // distance of c from the line, as a share of the contrast
constexpr double prior = 0.05;       // weight of "not mixed" against the colours, as a share of their size
constexpr double least_share = 0.02; // less than this of a pixel is not worth a sample

struct Rgb {
    std::array<double, 3> v{};
    double dot(const Rgb &o) const { return v[0] * o.v[0] + v[1] * o.v[1] + v[2] * o.v[2]; }
    Rgb minus(const Rgb &o) const { return {{v[0] - o.v[0], v[1] - o.v[1], v[2] - o.v[2]}}; }
};

// What a surface shows around a pixel: a mean over samples.
struct Estimate {
    std::vector<Term> terms; // coefficients sum to 1
    Rgb colour;
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
    std::optional<Estimate> estimate(int x, int y, double depth, double edge) const;
    std::optional<double> share_of(const Rgb &c, const Rgb &f, const Rgb &b, bool own_is_far) const;
    void emit_mixture(std::uint64_t i, const Mixture &mixture, Ldi &out) const;

    // visit(sample, dx, dy) for the samples of the pixels within `reach` of (x, y).
    template <typename Visit>
    void around(int x, int y, int reach, const Visit &visit) const;

    std::size_t pixel_of(int x, int y) const {
        return std::size_t(y) * std::size_t(view_.windows.width()) + std::size_t(x);
    }
    bool is_empty(std::size_t pixel) const { return view_.begin[pixel] == view_.begin[pixel + 1]; }
    double depth_of(std::uint64_t i) const { return depths_[i]; }
    bool is_opaque(std::uint64_t i) const { return alpha_at(view_, alpha_, i) >= 1; }
    Rgb colour_of(std::uint64_t i) const {
        Rgb c;
        for (std::size_t k = 0; k < 3; ++k) c.v[k] = double(view_.values[rgb_[k]][i]);
        return c;
    }

    const Ldi &view_;
    double scale_, jump_;
    std::size_t alpha_;
    std::array<std::size_t, 3> rgb_;
    bool usable_;
    std::vector<double> depths_;       // of each sample, perceptive
    std::vector<unsigned char> sides_; // of the first sample of each pixel
};

Separation::Separation(const Ldi &view, double scale, double jump)
    : view_(view), scale_(scale), jump_(jump), alpha_(view.alpha()), rgb_(), usable_(true) {
    for (std::size_t k = 0; k < 3; ++k) {
        rgb_[k] = find_channel(view.channels, std::array{"R", "G", "B"}[k]);
        usable_ = usable_ && rgb_[k] != npos;
    }
    depths_.resize(view.samples());
    std::ranges::transform(view.z, depths_.begin(), [scale](float z) { return scale / double(z); });
    sides_.assign(view.samples(), inside);
    if (!usable_ || alpha_ == npos) return;
    parallel_for(std::size_t(view.windows.height()), [&](std::size_t y) {
        for (int x = 0; x < view_.windows.width(); ++x)
            if (const std::size_t pixel = pixel_of(x, int(y)); !is_empty(pixel))
                sides_[view_.begin[pixel]] = side_of(x, int(y));
    });
}

unsigned char Separation::side_of(int x, int y) const {
    const double own = depth_of(view_.begin[pixel_of(x, y)]);
    unsigned char side = inside;
    around(x, y, 1, [&](std::uint64_t i, int, int) {
        if (depth_of(i) > own + jump_) side |= has_nearer;
        if (depth_of(i) < own - jump_) side |= has_farther;
    });
    return side;
}

template <typename Visit>
void Separation::around(int x, int y, int reach, const Visit &visit) const {
    const int width = view_.windows.width(), height = view_.windows.height();
    for (int v = std::max(y - reach, 0); v <= std::min(y + reach, height - 1); ++v)
        for (int u = std::max(x - reach, 0); u <= std::min(x + reach, width - 1); ++u) {
            const std::size_t pixel = pixel_of(u, v);
            if (!is_empty(pixel)) visit(view_.begin[pixel], u - x, v - y);
        }
}

// By the square of the distance in pixels.
const auto nearness = [] {
    std::array<double, 2 * radius * radius + 1> table{};
    for (std::size_t d2 = 0; d2 < table.size(); ++d2) table[d2] = std::exp(-0.5 * double(d2));
    return table;
}();

// The mean of the surface at that depth over the pixels around that nothing nearer may be mixed into; those that
// something farther may be mixed into count by `edge`.
std::optional<Estimate> Separation::estimate(int x, int y, double depth, double edge) const {
    Estimate result;
    result.terms.reserve((2 * radius + 1) * (2 * radius + 1));
    double sum = 0;
    around(x, y, radius, [&](std::uint64_t i, int dx, int dy) {
        if (std::abs(depth_of(i) - depth) >= jump_ || (sides_[i] & has_nearer) || !is_opaque(i)) return;
        const double weight = nearness[std::size_t(dx * dx + dy * dy)] * (sides_[i] & has_farther ? edge : 1);
        result.terms.push_back({i, weight});
        sum += weight;
    });
    if (sum < least_support) return {};
    for (Term &term : result.terms) {
        term.coefficient /= sum;
        const Rgb c = colour_of(term.index);
        for (std::size_t k = 0; k < 3; ++k) result.colour.v[k] += term.coefficient * c.v[k];
    }
    return result;
}

// The share of f in c, by least squares with a prior that the pixel is not mixed.
std::optional<double> Separation::share_of(const Rgb &c, const Rgb &f, const Rgb &b, bool own_is_far) const {
    const Rgb contrast = f.minus(b), offset = c.minus(b);
    const double size = 0.5 * (f.dot(f) + b.dot(b)), distance = contrast.dot(contrast);
    if (distance <= least_contrast * least_contrast * size) return {};
    const double doubt = prior * prior * size, unmixed = own_is_far ? 0 : 1;
    double share = (offset.dot(contrast) + doubt * unmixed) / (distance + doubt);
    share = own_is_far ? std::clamp(share, 0.0, 0.5) : std::clamp(share, 0.5, 1.0);
    Rgb rest = offset;
    for (std::size_t k = 0; k < 3; ++k) rest.v[k] -= share * contrast.v[k];
    if (rest.dot(rest) > largest_residual * largest_residual * distance) return {};
    // What is left in front after taking out b must be light.
    for (std::size_t k = 0; k < 3; ++k)
        if ((1 - share) * b.v[k] > c.v[k]) share = 1 - std::max(c.v[k], 0.0) / b.v[k];
    if (!(share >= least_share && share <= 1 - least_share)) return {}; // nor where a colour is no number
    return share;
}

std::optional<Mixture> Separation::mixture_of(int x, int y) const {
    const std::uint64_t own = view_.begin[pixel_of(x, y)];
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
    const auto front = estimate(x, y, mixture.near_depth, edge_share),
               behind = estimate(x, y, mixture.far_depth, 1);
    if (!front || !behind) return {};
    const auto share = share_of(colour_of(own), front->colour, behind->colour, own_is_far);
    if (!share) return {};
    mixture.share = *share;
    mixture.behind = *behind;
    return mixture;
}

void Separation::emit_mixture(std::uint64_t i, const Mixture &mixture, Ldi &out) const {
    std::vector<Term> front{{i, 1}};
    for (const Term &term : mixture.behind.terms)
        front.push_back({term.index, -(1 - mixture.share) * term.coefficient});
    MergedSample sample = placement_of(view_, i);
    sample.z = sample.z_back = float(scale_ / mixture.near_depth);
    sample.terms = front;
    append(out, view_, sample);
    sample.z = sample.z_back = float(scale_ / mixture.far_depth);
    sample.weight = estimate_weight;
    sample.terms = mixture.behind.terms;
    append(out, view_, sample);
}

void Separation::emit_pixel(std::size_t pixel, Ldi &out) const {
    if (is_empty(pixel)) return;
    const std::uint64_t own = view_.begin[pixel];
    const std::size_t width = std::size_t(view_.windows.width());
    if (sides_[own] != inside && is_opaque(own))
        if (const auto mixture = mixture_of(int(pixel % width), int(pixel / width)))
            return emit_mixture(own, *mixture, out);
    append(out, view_, own);
}

} // namespace

Ldi separate_silhouettes(const Ldi &view, double scale, double jump) {
    const Separation separation(view, scale, jump);
    return build_by_pixels(view, [&](std::size_t pixel, Ldi &out) { separation.emit_pixel(pixel, out); });
}

} // namespace sparselens
