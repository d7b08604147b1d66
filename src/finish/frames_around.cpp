#include "finish/frames_around.h"

#include "base/parallel.h"
#include "finish/tuning.h"
#include "finish/window_means.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sparselens {

namespace {

constexpr std::size_t pixels_at_once = std::size_t(1) << 14;

float residual(const FrameOfLayer &frame, std::size_t half, std::size_t channel, std::size_t i) {
    return frame.rays[half][channel][i] - frame.gathered[channel][i];
}

// What two frames of a layer tell about each pixel, weighted by how visible it is.
struct Compared {
    Values changed;            // product of both changes of the residual
    Values noise, other_noise; // of one residual of each frame, squared
    Values moved;              // logarithm of the squared change of the gathered picture over the noise

    float both(std::size_t i) const { return noise[i] + other_noise[i]; }
};

Compared compared(const FrameOfLayer &frame, const FrameOfLayer &other, const ArrayGrid &grid) {
    const Values zeros(grid.size(), 0.0f);
    Compared found{zeros, zeros, zeros, zeros};
    const float exposure = exposure_of(frame.gathered);
    parallel_ranges(grid.size(), pixels_at_once, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const float visible = seen(exposure * brightness(frame.gathered, i));
            for (std::size_t c = 0; c < frame.gathered.size(); ++c) {
                const float first = residual(frame, 0, c, i), second = residual(frame, 1, c, i);
                const float of_first = residual(other, 0, c, i), of_second = residual(other, 1, c, i);
                const float moved = frame.gathered[c][i] - other.gathered[c][i];
                found.changed[i] += visible * (first - of_first) * (second - of_second);
                found.noise[i] += visible * (first - second) * (first - second) / 2;
                found.other_noise[i] += visible * (of_first - of_second) * (of_first - of_second) / 2;
                found.moved[i] += visible * moved * moved;
            }
        }
    });
    for (Values *values : {&found.noise, &found.other_noise})
        soft_mean(*values, grid, FinishTuning::residual_radius);
    soft_mean(found.moved, grid, FinishTuning::moved_radius);
    // Running sums leave values a little below 0 beside lamps.
    for (Values *values : {&found.noise, &found.other_noise, &found.moved})
        for (float &value : *values) value = std::max(value, 0.0f);
    for (std::size_t i = 0; i < grid.size(); ++i)
        found.moved[i] = std::log((found.moved[i] + 1e-20f) / (found.both(i) + 1e-20f));
    return found;
}

// The mean change of residuals as a share of their noise, by how much the gathered picture has changed.
class ChangeByMovement {
public:
    explicit ChangeByMovement(const Compared &frames)
        : classes_(FinishTuning::classes, -FinishTuning::log_of_movement, FinishTuning::log_of_movement),
          shares_(FinishTuning::classes) {
        const std::size_t pixels = frames.changed.size();
        for (std::size_t i = 0; i < pixels; ++i) classes_.add(frames.moved[i], 1);
        classes_.divide();
        std::vector<std::size_t> counts(shares_.size());
        for (std::size_t i = 0; i < pixels; ++i) {
            const float noise = frames.both(i);
            if (!(noise > 0)) continue;
            const std::size_t at = classes_.of(frames.moved[i]);
            shares_[at] += double(frames.changed[i] / noise);
            ++counts[at];
        }
        for (std::size_t k = 0; k < shares_.size(); ++k)
            shares_[k] = std::max(shares_[k] / double(std::max<std::size_t>(counts[k], 1)), 0.0);
    }

    float at(const Compared &frames, std::size_t i) const {
        return float(shares_[classes_.of(frames.moved[i])]) * frames.both(i);
    }

private:
    Classes classes_;
    std::vector<double> shares_; // sums of many pixels
};

} // namespace

Values weight_of(const FrameOfLayer &frame, const FrameOfLayer &other, std::size_t frames,
                 const ArrayGrid &grid) {
    Compared found = compared(frame, other, grid);
    const ChangeByMovement by_movement(found);
    soft_mean(found.changed, grid, FinishTuning::residual_radius);
    Values weight(grid.size());
    parallel_ranges(grid.size(), pixels_at_once, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const float here = found.changed[i] - FinishTuning::residual_deviations * found.both(i);
            const float all =
                found.other_noise[i] + 2 * float(frames) * std::max(here, by_movement.at(found, i));
            weight[i] = all > 0 ? std::min(found.noise[i] / all, 1.0f) : 0;
        }
    });
    return weight;
}

Halves averaged_rays(const FrameOfLayer &frame, std::span<const FrameOfLayer> around, const ArrayGrid &grid) {
    Halves averaged = frame.rays;
    std::vector<Values> weights;
    for (const FrameOfLayer &other : around) weights.push_back(weight_of(frame, other, around.size(), grid));
    parallel_ranges(grid.size(), pixels_at_once, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            float all = 1;
            for (const Values &weight : weights) all += weight[i];
            for (std::size_t half = 0; half < 2; ++half)
                for (std::size_t c = 0; c < frame.gathered.size(); ++c) {
                    float sum = residual(frame, half, c, i);
                    for (std::size_t k = 0; k < around.size(); ++k)
                        sum += weights[k][i] * residual(around[k], half, c, i);
                    averaged[half][c][i] = frame.gathered[c][i] + sum / all;
                }
        }
    });
    return averaged;
}

} // namespace sparselens
