// The light of samples in a picture of layers: R + G + B, less what samples in front hide.
#pragma once

#include "base/parallel.h"
#include "deep/view_samples.h"

#include <algorithm>
#include <array>
#include <vector>

namespace sparselens {

inline float value_in(const Ldi &ldi, std::size_t channel, std::uint64_t i) { return ldi.values[channel][i]; }

inline float value_in(const ViewSamples &view, std::size_t channel, std::uint64_t i) {
    return view.value(channel, i);
}

// The light of pixels of an Ldi or of ViewSamples.
template <typename Samples>
class PixelLight {
public:
    explicit PixelLight(const Samples &samples)
        : samples_(samples), rgb_(find_rgb(samples.channels)), alpha_(samples.alpha()) {}

    bool is_known() const { return all_found(rgb_); }

    // Calls visit(sample, light) for the samples of a pixel, front to back.
    template <typename Visit>
    void visit(std::size_t pixel, const Visit &visit) const {
        double clear = 1;
        for (const std::uint64_t i : samples_.pixel(pixel)) {
            double own = 0;
            for (const std::size_t k : rgb_) own += double(value_in(samples_, k, i));
            visit(i, clear * own);
            clear *= 1 - std::clamp(double(alpha_at(samples_, alpha_, i)), 0.0, 1.0);
        }
    }
    double at(std::size_t pixel) const {
        double sum = 0;
        visit(pixel, [&](std::uint64_t, double light) { sum += light; });
        return sum;
    }

    // The light of all pixels of the data window.
    std::vector<float> picture() const {
        std::vector<float> light(samples_.windows.pixels());
        parallel_ranges(light.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) light[i] = float(at(i));
        });
        return light;
    }

private:
    const Samples &samples_;
    std::array<std::size_t, 3> rgb_;
    std::size_t alpha_;
};

inline bool is_before(const Imath::V2i &a, const Imath::V2i &b) { return a.y != b.y ? a.y < b.y : a.x < b.x; }

// Returns all pixels within `reach` of these, each once, row by row.
inline std::vector<Imath::V2i> grown(std::span<const Imath::V2i> pixels, int reach) {
    std::vector<Imath::V2i> result;
    for (const Imath::V2i &p : pixels)
        for (int y = -reach; y <= reach; ++y)
            for (int x = -reach; x <= reach; ++x) result.push_back(p + Imath::V2i(x, y));
    std::sort(result.begin(), result.end(), is_before);
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

// `pixels`: from grown().
inline bool is_among(std::span<const Imath::V2i> pixels, const Imath::V2i &pixel) {
    return std::binary_search(pixels.begin(), pixels.end(), pixel, is_before);
}

} // namespace sparselens
