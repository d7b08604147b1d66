#include "warp/silhouettes.h"

#include "base/light.h"
#include "base/parallel.h"
#include "deep/mixed_pixels.h"
#include "lens/thin_lens.h"
#include "warp/matting/matte_shares.h"
#include "warp/tuning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace sparselens {

namespace {

// Opaque pixels mix opaque surfaces. A veil's density, like what a pixel leaves open, differs from pixel to pixel.
std::optional<VeilMix> unmix_before(const Imath::V4d &behind, const Imath::V4d &c, const Imath::V4d &front,
                                    const MixPrior &prior, double largest_residual) {
    if (!is_opaque(float(behind[3])) || !is_opaque(float(c[3])))
        return unmix_veil(c, front, behind, largest_residual);
    const auto mix = unmix(rgb(c), rgb(front), rgb(behind), prior, largest_residual);
    if (!mix) return {};
    return VeilMix{mix->share, 1, mix->residual};
}

// The colour of a surface around a pixel: a mean over samples.
struct Estimate {
    std::vector<Term> terms; // coefficients sum to 1
    Imath::V4d colour{0, 0, 0, 0};
    bool pure = false; // whether some terms are pixels that nothing else is mixed into
};

class Separation {
public:
    Separation(const ViewSamples &view, double scale, double jump, std::span<const std::size_t> crossed_lamps,
               const BackgroundFromViews *others);
    bool may_be_mixed(std::size_t pixel) const;
    void emit_pixel(std::size_t pixel, Ldi &out) const; // appends a pixel that may be mixed, if it is mixed

private:
    enum Side : unsigned char { inside = 0, has_nearer = 1, has_farther = 2 };

    unsigned char side_of(int x, int y) const;
    std::optional<Mixture> find(int x, int y) const;
    bool is_of_crossed_lamp(int x, int y) const;
    Mixture of_lamp(int x, int y, const Mixture &light) const;
    std::optional<Mixture> mixture_of(int x, int y) const;
    enum class Needs { opaque, any };
    std::optional<Estimate> estimate(int x, int y, double depth, Needs needs) const;
    bool is_disproved(const Position &at, const Mixture &mixture) const;
    Imath::V4d purest(int x, int y, double depth, const Imath::V4d &front, const Imath::V4d &behind) const;
    std::optional<Mixture> with_one_pixel(int x, int y, double near_depth, const Imath::V4d &front) const;
    void emit_mixture(std::uint64_t i, const Mixture &mixture, Ldi &out) const;

    template <typename Visit>
    void around(int x, int y, int reach, const Visit &visit) const {
        samples_.around(x, y, reach, visit);
    }
    std::uint64_t own_sample(int x, int y) const { return samples_.own_sample(x, y); }
    double depth_of(std::uint64_t i) const { return samples_.depth_of(i); }
    bool is_opaque(std::uint64_t i) const { return samples_.is_opaque(i); }
    Imath::V4d colour_of(std::uint64_t i) const { return samples_.rgba_of(i); }
    // Whether a sample belongs to the surface at that depth, and nothing nearer may be mixed into it.
    bool tells_of(double depth, std::uint64_t i) const {
        return !(std::abs(depth_of(i) - depth) >= jump_ || (sides_[i] & has_nearer));
    }

    const ViewSamples &view_;
    SamplesAround samples_;
    double scale_, jump_;
    std::span<const std::size_t> crossed_lamps_; // pixels, ascending
    const BackgroundFromViews *others_;          // may be null
    std::vector<Matte> mattes_;
    std::vector<unsigned char> sides_; // of each pixel
};

Separation::Separation(const ViewSamples &view, double scale, double jump,
                       std::span<const std::size_t> crossed_lamps, const BackgroundFromViews *others)
    : view_(view), samples_(view, scale), scale_(scale), jump_(jump), crossed_lamps_(crossed_lamps),
      others_(others), mattes_(find_mattes(view.channels)) {
    sides_.assign(view.windows.pixels(), inside);
    if (!samples_.have_colours()) return;
    const ArrayGrid &grid = samples_.grid();
    parallel_for(std::size_t(grid.height()), [&](std::size_t y) {
        for (int x = 0; x < grid.width(); ++x)
            if (!samples_.is_empty(grid.index(Position(x, int(y)))))
                sides_[own_sample(x, int(y))] = side_of(x, int(y));
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

// The weight of a pixel by the square of its distance, in pixels.
const auto nearness = [] {
    std::array<double, 2 * WarpTuning::silhouette_radius * WarpTuning::silhouette_radius + 1> table{};
    for (std::size_t d2 = 0; d2 < table.size(); ++d2) table[d2] = std::exp(-0.5 * double(d2));
    return table;
}();

// Returns the mean of the surface at that depth over the pixels around that nothing nearer may be mixed into. Pixels
// that something farther may be mixed into count less, because a lamp behind the surface would shine at its depth.
std::optional<Estimate> Separation::estimate(int x, int y, double depth, Needs needs) const {
    Estimate result;
    result.terms.reserve((2 * WarpTuning::silhouette_radius + 1) * (2 * WarpTuning::silhouette_radius + 1));
    double sum = 0;
    around(x, y, WarpTuning::silhouette_radius, [&](std::uint64_t i, int dx, int dy) {
        if (!tells_of(depth, i) || (needs == Needs::opaque && !is_opaque(i))) return;
        const double weight = nearness[std::size_t(dx * dx + dy * dy)] *
                              (sides_[i] & has_farther ? WarpTuning::silhouette_edge_share : 1);
        result.terms.push_back({i, weight});
        result.pure = result.pure || !(sides_[i] & has_farther);
        sum += weight;
    });
    if (sum < WarpTuning::silhouette_least_support) return {};
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
    double nearest = 3; // of the farther pixels; those beside it come before those at its corners
    around(x, y, 1, [&](std::uint64_t i, int dx, int dy) {
        const double depth = depth_of(i);
        if (own_is_far) mixture.near_depth = std::max(mixture.near_depth, depth);
        if (own_is_far || depth >= depth_of(own) - jump_) return;
        const int distance = dx * dx + dy * dy;
        if (distance < nearest || (distance == nearest && depth > mixture.far_depth))
            mixture.far_depth = depth;
        nearest = std::min(nearest, double(distance));
    });
    const auto front = estimate(x, y, mixture.near_depth, Needs::opaque),
               behind = estimate(x, y, mixture.far_depth, Needs::any);
    if (!front) return {};
    if (!behind) return with_one_pixel(x, y, mixture.near_depth, front->colour);
    const Imath::V4d f =
        front->pure ? front->colour : purest(x, y, mixture.near_depth, front->colour, behind->colour);
    const auto mix = unmix_before(behind->colour, colour_of(own), f, own_is_far ? mostly_b : mostly_f,
                                  WarpTuning::silhouette_residual);
    if (!mix) return with_one_pixel(x, y, mixture.near_depth, f);
    mixture.share = mix->share;
    mixture.behind = behind->terms;
    for (Term &term : mixture.behind) term.coefficient *= mix->density;
    return mixture;
}

// Returns the colour of the least mixed pixel of a surface that has edges in all its pixels, such as a wire or a small
// lamp: the pixel that differs most from what is behind.
Imath::V4d Separation::purest(int x, int y, double depth, const Imath::V4d &front,
                              const Imath::V4d &behind) const {
    const Imath::V4d contrast = front - behind;
    Imath::V4d result = front;
    around(x, y, 1, [&](std::uint64_t i, int, int) {
        if (!tells_of(depth, i) || !is_opaque(i)) return;
        if (const Imath::V4d c = colour_of(i); (c - result).dot(contrast) > 0) result = c;
    });
    return result;
}

// The surface behind may be smaller than the area of a mean, such as a lamp or a stripe. The farther pixel around that
// explains the colour best is then taken for it.
std::optional<Mixture> Separation::with_one_pixel(int x, int y, double near_depth,
                                                  const Imath::V4d &front) const {
    const std::uint64_t own = own_sample(x, y);
    const bool own_is_far = sides_[own] & has_nearer;
    std::optional<Mixture> best;
    double least = std::numeric_limits<double>::infinity();
    around(x, y, 1, [&](std::uint64_t i, int, int) {
        if (i == own || depth_of(i) >= near_depth - jump_) return;
        const auto mix = unmix_before(colour_of(i), colour_of(own), front, own_is_far ? mostly_b : mostly_f,
                                      WarpTuning::silhouette_residual_of_one);
        if (!mix || mix->residual >= least) return;
        if (std::min(mix->share, 1 - mix->share) < WarpTuning::silhouette_least_share_of_one) return;
        least = mix->residual;
        best = {near_depth, depth_of(i), mix->share, {{i, mix->density}}};
    });
    return best;
}

void Separation::emit_mixture(std::uint64_t i, const Mixture &mixture, Ldi &out) const {
    float weight = 1;
    const auto emit = [&](double depth, std::span<const Term> terms) {
        append(out, view_, float(depth_at_disparity(scale_, depth)), weight, terms);
        weight = WarpTuning::estimate_weight; // of the sample behind, which comes next
    };
    const double share = mixture.share;
    const std::vector<Term> whole{{i, 1}};
    if (share == 0) return emit(mixture.far_depth, whole);
    std::vector<Term> front = whole, behind = mixture.behind;
    if (mixture.front) {
        front = {{*mixture.front, share}};
        behind = {{i, 1 / (1 - share)}, {*mixture.front, -share / (1 - share)}};
    } else {
        for (const Term &term : behind) front.push_back({term.index, -(1 - share) * term.coefficient});
    }
    emit(mixture.near_depth, front);
    emit(mixture.far_depth, behind);
    share_mattes(view_, i, front, share, mattes_, out);
}

bool Separation::is_of_crossed_lamp(int x, int y) const {
    return std::ranges::binary_search(crossed_lamps_, samples_.grid().index(Position(x, y)));
}

// Treats a lamp's own pixel. The pixels around may tell how much of it is covered by what crosses the lamp, which shows
// no more light than unlit strands do; the lamp shows the rest.
Mixture Separation::of_lamp(int x, int y, const Mixture &light) const {
    std::optional<Mixture> mixture = mixture_of(x, y);
    if (!mixture) return light;
    mixture->front = light.front;
    return *mixture;
}

std::optional<Mixture> Separation::find(int x, int y) const {
    if (!is_opaque(own_sample(x, y))) return mixture_of(x, y);
    const bool strands = among_strands(samples_, x, y);
    if (strands || is_of_crossed_lamp(x, y))
        if (const auto light = light_between_strands(samples_, x, y, jump_,
                                                     strands ? WarpTuning::strand_apart_px : jump_, others_))
            return strands || light->far_depth != depth_of(own_sample(x, y)) ? light : of_lamp(x, y, *light);
    return strands ? strands_before(samples_, x, y, others_) : mixture_of(x, y);
}

// Whether what a pixel is taken to show behind its own surface is an estimate that another view looks past. A glint, for
// instance, is not a small share of a lamp that stands beside it.
bool Separation::is_disproved(const Position &at, const Mixture &mixture) const {
    return others_ && mixture.share > 0 &&
           mixture.far_depth < depth_of(own_sample(at.column, at.row)) - jump_ &&
           others_->see_past(at, mixture.far_depth);
}

bool Separation::may_be_mixed(std::size_t pixel) const {
    if (samples_.is_empty(pixel)) return false;
    const std::uint64_t own = view_.pixel(pixel).front();
    return sides_[own] != inside;
}

void Separation::emit_pixel(std::size_t pixel, Ldi &out) const {
    const std::uint64_t own = view_.pixel(pixel).front();
    const Position at = samples_.grid().position(pixel);
    const std::optional<Mixture> mixture = find(at.column, at.row);
    if (mixture && !is_disproved(at, *mixture)) emit_mixture(own, *mixture, out);
}

} // namespace

void separate_silhouettes(ViewSamples &view, double scale, double jump,
                          std::span<const std::size_t> crossed_lamps, const BackgroundFromViews *others) {
    const Separation separation(view, scale, jump, crossed_lamps, others);
    view.replace([&](std::size_t pixel) { return separation.may_be_mixed(pixel); },
                 [&](std::size_t pixel, Ldi &out) { separation.emit_pixel(pixel, out); });
}

} // namespace sparselens
