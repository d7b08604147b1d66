// How steady a sequence of pictures is, and how well its changes match those of a reference sequence.
//
// Let v(t) be a tone-mapped value (light.h) of frame t. Smooth motion changes v evenly; popping and sparkling do
// not. So steadiness is measured by second differences over time,
// |v(t - 1) - 2 v(t) + v(t + 1)|. The second difference of a pixel is the largest over R, G, B and all frames. Changes
// are compared by first differences, v(t) - v(t - 1).
#pragma once

#include "../base/image.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace sparselens {

// Thresholds of a second difference. In one step of focus, people see more than the first as a flicker, and more than
// the second as a sparkle.
inline constexpr std::array temporal_thresholds{0.02, 0.05};

struct Steadiness {
    std::array<std::size_t, temporal_thresholds.size()> above{}; // pixels with larger second differences
    double largest = 0;                                          // over all pixels
};

struct TemporalFigures {
    std::size_t frames = 0, pixels = 0;
    std::size_t nonfinite =
        0; // pixels that are infinite or NaN in any frame of either sequence, and left out
    Steadiness image;
    // With a reference: its steadiness, and -10 log10 of the mean squared error of the change from frame to frame, dB;
    // infinite if all changes are equal.
    std::optional<Steadiness> reference;
    std::optional<double> psnr_change;
};

// Takes one frame after another and keeps only the last two.
class TemporalError {
public:
    // Frames are as rgba_over() returns them (image_error.h), all with one data window. `reference`: the same frame of
    // the reference sequence, in all calls or in none.
    void add(const Image &image, const Image *reference = nullptr);
    TemporalFigures figures() const;

private:
    // A sequence: the last two frames, tone-mapped, and the largest second difference of each pixel so far.
    struct Sequence {
        std::vector<float> before, last;
        std::vector<double> worst;
        void add(std::vector<float> now, std::size_t frames);
    };
    std::size_t frames_ = 0;
    std::vector<char> finite_; // [pixel]: in all frames so far; char, for parallel rows
    Sequence image_, reference_;
    bool has_reference_ = false;
    std::vector<double> change_; // [pixel]: sum of the squared errors of its changes
};

} // namespace sparselens
