// Separates strands thinner than a pixel, such as hair, fur and grass far away, from what is behind them.
//
// No pixel among strands shows one surface, and a renderer gives it the depth of one of its samples, so that it is
// chance whether the depth is that of hair or of what is behind. Such areas are recognised by depths that jump often
// between neighbours along rows and along columns; edges and bars mostly jump along one of them. There the depth of a
// pixel does not say what it shows more of, and single pixels around tell what the surfaces show:
//
//   - A pixel that is four times as bright as the strands holds light from between them. The light belongs to the
//     brightest pixel behind, a lamp: a = (b - c) / (b - f) of brightnesses. The same is true of a lamp that a single
//     strand crosses. If other views see no such light there, the strand itself is lit.
//   - Else B is what other views show behind the strands, or a farther pixel around if all of them are mixed there, too.
//     F is the strand with the smallest share, among those around that explain the colour with B, because most pixels of
//     strands are mixed. The median over all B decides.
#pragma once

#include "base/grid.h"
#include "base/light.h"
#include "base/parallel.h"
#include "deep/build.h"
#include "deep/view_samples.h"
#include "lens/thin_lens.h"
#include "view/view_mapping.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

// The colour that other views show of a surface that something nearer hides or mixes in one view.
class BackgroundFromViews {
public:
    // `views` and `mappings` are those of all views, which have the same channels; they must outlive this. `own` is the
    // view that mixes the surfaces. `scale` is R F, pixels times scene units. It reads only the samples that the views had
    // at first: see ViewSamples::replace().
    BackgroundFromViews(std::span<const ViewSamples> views, std::span<const ViewMapping> mappings,
                        std::size_t own, double scale);

    // Returns the colour of the surface at that disparity, where the ray of the own view's pixel meets
    // it: the mean over the other flat views that show the surface there, opaque, and nothing
    // that is nearer by `apart` or more in that pixel or beside it. Returns nothing if there is no such view.
    std::optional<Imath::V3d> colour_behind(const Position &pixel, double depth, double apart) const;

    // Returns the brightness of the brightest pixel where the other flat views look at that depth, or beside it.
    // A view with something as near as `nearest` there does not count; returns nothing if none counts.
    std::optional<double> brightest_at(const Position &pixel, double depth, double nearest) const;

    // Whether another flat view looks past a surface of that depth: it shows something there, and nothing as near, neither
    // there nor beside it.
    bool see_past(const Position &pixel, double depth) const;

private:
    template <typename Visit>
    void for_each_other(const Position &pixel, double depth, const Visit &visit) const;
    Imath::V3d colour_of(const ViewSamples &samples, std::size_t pixel) const;
    struct Around { // of three by three pixels
        double nearest = 0, brightest = 0;
    };
    Around around(const ViewSamples &samples, std::size_t pixel) const;

    std::span<const ViewSamples> views_;
    std::span<const ViewMapping> mappings_;
    std::size_t own_;
    double scale_;
    std::array<std::size_t, 3> rgb_;
    std::size_t alpha_;
};

// The samples of a view with at most one per pixel, and the samples around them. Depths are disparities, R F / z:
// pixels, larger is nearer.
class SamplesAround {
public:
    // Refers to the view; scale is R F, pixels times scene units.
    SamplesAround(const ViewSamples &view, double scale)
        : view_(view), grid_(view.windows.grid().array()), alpha_(view.alpha()),
          rgb_(find_rgb(view.channels)), depths_(grid_.size()) {
        parallel_ranges(depths_.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) depths_[i] = disparity(scale, double(view.z(i)));
        });
    }

    bool have_colours() const { return alpha_ != npos && all_found(rgb_); }
    const ArrayGrid &grid() const { return grid_; }
    bool is_empty(std::size_t pixel) const { return view_.pixel(pixel).empty(); }
    std::uint64_t own_sample(int x, int y) const { return view_.pixel(grid_.index(Position(x, y))).front(); }

    double depth_of(std::uint64_t i) const { return depths_[i]; }
    std::span<const double> depths() const { return depths_; } // of all pixels
    bool is_opaque(std::uint64_t i) const { return sparselens::is_opaque(alpha_at(view_, alpha_, i)); }
    Imath::V3d colour_of(std::uint64_t i) const {
        const auto value = [&](std::size_t k) { return double(view_.value(rgb_[k], i)); };
        return {value(0), value(1), value(2)};
    }

    Imath::V4d rgba_of(std::uint64_t i) const {
        const Imath::V3d c = colour_of(i);
        return {c.x, c.y, c.z, double(alpha_at(view_, alpha_, i))};
    }

    // Calls visit(sample, dx, dy) for the samples of the pixels within `reach` of (x, y).
    template <typename Visit>
    void around(int x, int y, int reach, const Visit &visit) const {
        for (int v = std::max(y - reach, 0); v <= std::min(y + reach, grid_.height() - 1); ++v)
            for (int u = std::max(x - reach, 0); u <= std::min(x + reach, grid_.width() - 1); ++u)
                if (const std::size_t pixel = grid_.index(Position(u, v)); !is_empty(pixel))
                    visit(view_.pixel(pixel).front(), u - x, v - y);
    }

private:
    const ViewSamples &view_;
    ArrayGrid grid_;
    std::size_t alpha_;
    std::array<std::size_t, 3> rgb_;
    std::vector<double> depths_; // of each pixel
};

// A pixel of a view that mixes two surfaces: c = a F + (1 - a) B, where F is what the nearer one shows and B what the
// farther one does.
struct Mixture {
    double near_depth, far_depth; // disparity
    double share;                 // a, of the nearer surface; 0: all of the pixel belongs to the farther one
    // B. The coefficients sum to 1, or to the density of a veil. The nearer surface shows the rest of the pixel.
    std::vector<Term> behind;
    std::optional<std::uint64_t> front = {}; // F, one sample; then the farther surface shows the rest
};

// Whether the pixel stands among strands: of the 20 pairs of neighbours within two pixels, five or more jump by more
// than two pixels of disparity, along rows and along columns.
bool among_strands(const SamplesAround &samples, int x, int y);

// The light from between strands in a pixel among them, or in a lamp that they cross, if it has any. Pixels of
// disparity: `jump` parts the lamp from what is behind it, `apart` the strands from both. `others` may be null.
std::optional<Mixture> light_between_strands(const SamplesAround &samples, int x, int y, double jump,
                                             double apart, const BackgroundFromViews *others);

// The share of strands in a pixel among them, if the pixels around or other views explain its colour.
std::optional<Mixture> strands_before(const SamplesAround &samples, int x, int y,
                                      const BackgroundFromViews *others);

} // namespace sparselens
