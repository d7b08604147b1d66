#include "finish/similar_pixels.h"

#include "base/parallel.h"
#include "finish/regression.h"
#include "finish/tuning.h"

namespace sparselens {

namespace {

constexpr int band_rows = 16;
constexpr int reach = FinishTuning::similar_reach;

Colours tone_mapped_of(const Colours &guide) {
    Colours mapped = guide;
    for (Values &channel : mapped)
        for (float &v : channel) v = std::max(v, 0.0f) / (1 + std::max(v, 0.0f));
    return mapped;
}

// 1 where two patches are as alike as noise lets them be, falling to 0. `difference`: squared, mean of the patch.
float likeness(float difference) {
    constexpr float noise = FinishTuning::similar_noise;
    const float excess = std::max(difference - 2 * noise, 0.0f) / (2 * noise);
    const float left = std::max(1 - excess / 4, 0.0f);
    return left * left * left; // close to exp(-excess), and 0 from 4 on
}

class Band {
public:
    Band(const Colours &mapped, std::span<const float> weights, const Grid &grid, int begin, int end)
        : mapped_(mapped), weights_(weights), width_(grid.width()), height_(grid.height()), begin_(begin),
          end_(end), differences_(std::size_t(end - begin + 2) * std::size_t(width_)),
          sums_(std::size_t(end - begin) * std::size_t(width_), 0.0f), row_(std::size_t(width_)) {}

    void gather(const Halves &rays, Halves &means) {
        for (int dy = -reach; dy <= reach; ++dy)
            for (int dx = -reach; dx <= reach; ++dx) add(rays, means, dx, dy);
        for (Colours &half : means)
            for (Values &channel : half)
                for (int y = begin_; y < end_; ++y)
                    for (int x = 0; x < width_; ++x) channel[at(x, y)] /= sums_[in_band(x, y)];
    }

private:
    std::size_t at(int x, int y) const { return std::size_t(y) * std::size_t(width_) + std::size_t(x); }
    std::size_t in_band(int x, int y) const { return at(x, y - begin_); }

    // Squared differences between pixels and those (dx, dy) away, from a row above the band to a row below it.
    void compare(int dx, int dy) {
        for (int y = begin_ - 1; y <= end_; ++y) {
            const int row = std::clamp(y, 0, height_ - 1), other = std::clamp(row + dy, 0, height_ - 1);
            float *differences = differences_.data() + at(0, y - begin_ + 1);
            for (int x = 0; x < width_; ++x) {
                const std::size_t here = at(x, row), there = at(std::clamp(x + dx, 0, width_ - 1), other);
                float sum = 0;
                for (const Values &channel : mapped_) {
                    const float d = channel[here] - channel[there];
                    sum += d * d;
                }
                differences[x] = sum / float(mapped_.size());
            }
        }
    }

    float patch(int x, int y) const {
        const int left = std::max(x - 1, 0), right = std::min(x + 1, width_ - 1);
        float sum = 0;
        for (int k = 0; k < 3; ++k) {
            const float *row = differences_.data() + at(0, y - begin_ + k);
            sum += row[left] + row[x] + row[right];
        }
        return sum / 9;
    }

    void add(const Halves &rays, Halves &means, int dx, int dy) {
        compare(dx, dy);
        const int left = std::max(0, -dx), right = std::min(width_, width_ - dx);
        if (left >= right) return;
        for (int y = std::max(begin_, -dy); y < std::min(end_, height_ - dy); ++y) {
            const std::size_t here = at(left, y), there = at(left + dx, y + dy),
                              count = std::size_t(right - left);
            float *sums = sums_.data() + in_band(left, y);
            for (std::size_t i = 0; i < count; ++i) {
                row_[i] = likeness(patch(left + int(i), y)) * weights_[there + i];
                sums[i] += row_[i];
            }
            for (std::size_t h = 0; h < 2; ++h)
                for (std::size_t c = 0; c < means[h].size(); ++c) {
                    float *mean = means[h][c].data() + here;
                    const float *ray = rays[h][c].data() + there;
                    for (std::size_t i = 0; i < count; ++i) mean[i] += row_[i] * ray[i];
                }
        }
    }

    const Colours &mapped_;
    std::span<const float> weights_;
    int width_, height_, begin_, end_;
    std::vector<float> differences_, sums_, row_;
};

} // namespace

Halves means_of_similar(const Halves &rays, const Colours &guide, const Grid &grid) {
    const Colours mapped = tone_mapped_of(guide);
    const Values weights = tone_weights(guide);
    const Colours zero(guide.size(), Values(grid.size(), 0.0f));
    Halves means{zero, zero};
    parallel_ranges(std::size_t(grid.height()), std::size_t(band_rows),
                    [&](std::size_t begin, std::size_t end) {
                        Band(mapped, weights, grid, int(begin), int(end)).gather(rays, means);
                    });
    return means;
}

} // namespace sparselens
