// The sets of lens points that tiles choose from.
#pragma once

#include "dof/lens/lens_gather.h"
#include "lens/lens_samples.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <vector>

namespace sparselens {

// Each set is made when it is first asked for, by any thread.
class LensSets {
public:
    // The aperture must outlive this.
    LensSets(const LensGatherOptions &options, const Aperture &aperture, double pixel_aspect)
        : options_(options), aperture_(aperture), pixel_aspect_(pixel_aspect) {}

    // Returns the set for a tile whose largest CoC is `largest` pixels, with the number of points doubled `doubled`
    // times, at most twice.
    const std::vector<LensSample> &for_coc(float largest, std::size_t doubled);

private:
    // The error of a set falls with the number of points and grows with the blur. Measured on fence at 1920x1080
    // against 4096 points: 96 points at 4 pixels of CoC leave 50 dB, 256 points at 64 pixels 46 dB. A sub-pixel takes
    // 3/4 of the points that the CoC in pixels of the picture asks for. Fence and grass at 2 x 640x360 then have 51.6
    // and 48.6 dB; with points by the CoC in sub-pixels, 51.8 and 48.8; with half of the pixel's points, 51.0 and 48.3.
    static constexpr std::array<float, 6> largest_coc{6, 12, 20, 32, 48, INFINITY};
    static constexpr std::array<std::size_t, 6> normal_points{96, 128, 160, 192, 224, 256},
        final_points{288, 384, 480, 576, 896, 1024}; // up to 576 by steps of their own (lens_samples.h)

    LensSample through(const Imath::V2d &point) const;
    std::vector<LensSample> of_share(std::size_t points) const;
    static std::size_t step_for(float coc);
    std::size_t points_of(std::size_t step) const;
    std::size_t of_pixel(std::size_t step) const;

    LensGatherOptions options_;
    const Aperture &aperture_;
    double pixel_aspect_;
    static constexpr std::size_t steps = largest_coc.size();
    std::array<std::once_flag, 3 * steps> made_;
    std::array<std::vector<LensSample>, 3 * steps> sets_;
};

} // namespace sparselens
