#include "lens/lens_samples.h"

#include "base/numbers.h"
#include "lens/lens_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace sparselens {

namespace {

struct OwnStep {
    std::size_t points;
    double x, y; // pixels
};

// Steps for final quality, up to 32 pixels of CoC (dof/lens/tile_plan.h).
constexpr std::array own_steps = std::to_array<OwnStep>({{288, 0.549027, 0.279015},
                                                         {384, 0.484515, 0.778827},
                                                         {480, 0.514910, 0.700320},
                                                         {576, 0.317818, 0.515363}});

std::vector<Imath::V2d> positions_by(const OwnStep &step) {
    // In units of 2^-32, so that the fractional part is the integer product's wrap-around.
    const auto fraction = [](double of) { return std::uint32_t(of * 0x1p32); };
    const std::uint32_t x = fraction(step.x), y = fraction(step.y), middle = 1u << 31;
    std::vector<Imath::V2d> positions;
    for (std::uint32_t k = 0; k < step.points; ++k)
        positions.emplace_back(double(middle + k * x) * 0x1p-32, double(middle + k * y) * 0x1p-32);
    return positions;
}

} // namespace

std::vector<Imath::V2d> pixel_positions(std::size_t n) {
    const auto own = std::ranges::find(own_steps, n, &OwnStep::points);
    if (own != own_steps.end()) return positions_by(*own);
    std::vector<Imath::V2d> positions;
    for (std::uint32_t k = 0; k < n; ++k) positions.push_back(low_discrepancy_2d(k, {0.5, 0.5}));
    return positions;
}

std::vector<LensSample> disc_lens_samples(std::size_t n, double pixel_aspect) {
    std::vector<LensSample> samples;
    const std::vector<Imath::V2d> lens = spiral_lens_points(int(n)), pixel = pixel_positions(n);
    for (std::size_t k = 0; k < n; ++k)
        samples.push_back({float(lens[k].x), float(-lens[k].y * pixel_aspect), float(pixel[k].x - 0.5),
                           float(pixel[k].y - 0.5), 1});
    return samples;
}

std::vector<LensSample> lens_samples(const Aperture &aperture, std::size_t n, double pixel_aspect) {
    std::vector<LensSample> samples = disc_lens_samples(n, pixel_aspect);
    if (aperture.disc()) {
        const float narrower = float(1 / aperture.shape().squeeze);
        for (LensSample &s : samples) s.x *= narrower;
        return samples;
    }
    if (n == 1) return samples; // in the middle
    // The spiral in the unit square: the share within the radius, and the share of a turn.
    const double golden = (3 - std::sqrt(5.0)) / 2;
    for (std::size_t k = 0; k < n; ++k) {
        const double turns = golden * double(k);
        const LensPoint point = aperture.at({(double(k) + 0.5) / double(n), turns - std::floor(turns)});
        LensSample &s = samples[k];
        s.x = float(point.u.x);
        s.y = float(-point.u.y * pixel_aspect);
        s.rgb = point.rgb;
        s.behind = point.behind;
        s.in_front = point.in_front;
    }
    return samples;
}

} // namespace sparselens
