// LDIs made in memory, and pictures compared, for the tests of src/dof.
#pragma once

#include "base/random.h"
#include "deep/ldi.h"
#include "lens/thin_lens.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace sparselens::test {

struct Sample {
    double z;
    std::vector<float> values; // one for each channel
    float dx = 0, dy = 0;
};

// samples_at(x, y): what the pixel holds, in order of depth. Coordinates are EXR's.
inline Ldi make_ldi(const Windows &windows, const std::vector<Channel> &channels,
                    const std::function<std::vector<Sample>(int x, int y)> &samples_at) {
    Ldi ldi;
    ldi.windows = windows;
    ldi.channels = channels;
    ldi.values.resize(channels.size());
    ldi.begin.push_back(0);
    for (int y = windows.data.min.y; y <= windows.data.max.y; ++y)
        for (int x = windows.data.min.x; x <= windows.data.max.x; ++x) {
            for (const Sample &sample : samples_at(x, y)) {
                ldi.z.push_back(float(sample.z));
                ldi.dx.push_back(sample.dx);
                ldi.dy.push_back(sample.dy);
                for (std::size_t k = 0; k < channels.size(); ++k) ldi.values[k].push_back(sample.values[k]);
            }
            ldi.begin.push_back(ldi.z.size());
        }
    return ldi;
}

inline double random_unit(int a, int b, std::uint32_t stream) {
    return unit_interval(mix_bits(std::uint32_t(a), mix_bits(std::uint32_t(b), stream)));
}

// Depth at which this lens gives CoC c (c < R F / focus; focused on infinity, c < 0).
inline double depth_of(const ThinLens &lens, double c) {
    if (std::isinf(lens.focus)) return -lens.radius * lens.focal_px / c;
    return lens.focus / (1 - c * lens.focus / (lens.radius * lens.focal_px));
}

inline double largest_difference(const Image &a, const Image &b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        largest = std::max(largest, std::abs(double(a.values[i]) - double(b.values[i])));
    return largest;
}

// As many samples as depth wants: 0 to 3 a pixel, CoC from -6 to 4 px, offsets, a few lamps.
inline Ldi random_ldi(const Windows &windows, const ThinLens &lens, bool opaque, std::uint32_t stream) {
    std::vector<Channel> channels = rgba_channels();
    channels.push_back({"extra.Y", PixelType::half});
    if (opaque) channels.erase(channels.begin() + 3);
    return make_ldi(windows, channels, [&](int x, int y) {
        std::vector<Sample> samples;
        const int count = int(4 * random_unit(x, y, stream));
        for (int i = 0; i < count; ++i) {
            const auto random = [&](std::uint32_t k) {
                return random_unit(x, y, stream + 7 + 100 * k + std::uint32_t(i));
            };
            // Depths come in a few surfaces, so that layers form.
            const double c = -6 + 2.5 * double(int(4 * random(0))) + 0.8 * random(1);
            const float alpha = opaque || random(2) < 0.5 ? 1.0f : float(random(2));
            const float lamp = random(3) > 0.99 ? 50.0f : 1.0f;
            std::vector<float> values{float(random(4)) * alpha * lamp, float(random(5)) * alpha,
                                      float(random(6)) * alpha};
            if (!opaque) values.push_back(alpha);
            values.push_back(float(random(7)) * alpha);
            samples.push_back({depth_of(lens, c), values, float(random(8) - 0.5), float(random(9) - 0.5)});
        }
        std::sort(samples.begin(), samples.end(), [](const Sample &a, const Sample &b) { return a.z < b.z; });
        return samples;
    });
}

} // namespace sparselens::test
