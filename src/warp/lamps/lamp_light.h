// Gives small lamps the light that the views show.
//
// A view keeps the light of a lamp exactly: it is the sum over its few pixels. Where views are averaged it is not kept,
// because a pixel on a lamp's edge moves with the depth that the renderer gave it, and some views have more pixels of
// the lamp than others. So the samples of a lamp are scaled: its light becomes the mean over the views that see all of
// it.
#pragma once

#include "base/grid.h"
#include "base/parallel.h"
#include "deep/view_samples.h"
#include "warp/images/matched_view.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace sparselens {

// The LDI is the average of the views, the first of which is the centre. `scale` is R F; disparities that differ
// by less than `surface_px` pixels are one surface. Scales all channels of light except coverage. A lamp stays as it is
// if something nearer cuts it in the centre view, if less than half of the views see all of it and agree within noise,
// or if the change would be large.
void keep_light_of_lamps(std::span<const PlacedView> views, double scale, double surface_px, Ldi &ldi);

// Finds small bright lights in a picture, by brightness alone.
//
// A lamp is a group of pixels. The brightest has more than eight times the median of the block of 16 x 16 pixels around
// it; the others have more than four times that median, and more than a fiftieth of the brightest. Groups wider or
// higher than twelve pixels, and bright pixels beside them, are not lamps.
struct CompactLamp {
    std::vector<Imath::V2i> pixels; // the brightest first
    float limit;                    // all of them are brighter
    float surroundings;             // the median around it
};

// `brightness` of each pixel of the grid, row by row. No two lamps share a pixel.
std::vector<CompactLamp> find_compact_lamps(const Grid &grid, std::span<const float> brightness);

// The value of a sample in a channel.
inline float value_in(const Ldi &ldi, std::size_t channel, std::uint64_t i) { return ldi.values[channel][i]; }

inline float value_in(const ViewSamples &view, std::size_t channel, std::uint64_t i) {
    return view.value(channel, i);
}

// The light of samples and pixels of an Ldi or of ViewSamples: R + G + B, less what samples in front hide.
template <typename Samples>
class PixelLight {
public:
    explicit PixelLight(const Samples &samples)
        : samples_(samples), rgb_(find_rgb(samples.channels)), alpha_(samples.alpha()) {}

    bool is_known() const { return all_found(rgb_); }

    // Calls visit(sample, light) for the samples of a pixel, front to back.
    template <typename Visit>
    void visit(std::size_t pixel, const Visit &visit) const {
        for_shares(samples_, alpha_, samples_.pixel(pixel), [&](std::uint64_t i, double clear) {
            double own = 0;
            for (const std::size_t k : rgb_) own += double(value_in(samples_, k, i));
            visit(i, clear * own);
        });
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
