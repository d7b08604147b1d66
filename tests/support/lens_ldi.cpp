#include "support/lens_ldi.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

double depth_of(const ThinLens &lens, double c) {
    if (std::isinf(lens.focus)) return -lens.radius * lens.focal_px / c;
    return lens.focus / (1 - c * lens.focus / (lens.radius * lens.focal_px));
}

Ldi random_surfaces(const Windows &windows, const ThinLens &lens, bool opaque, std::uint32_t stream) {
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
            const double c = -6 + 2.5 * double(int(4 * random(0))) + 0.8 * random(1);
            const float alpha = opaque || random(2) < 0.5 ? 1.0f : float(random(2));
            const float lamp = random(3) > 0.99 ? 50.0f : 1.0f;
            std::vector<float> values{float(random(4)) * alpha * lamp, float(random(5)) * alpha,
                                      float(random(6)) * alpha};
            if (!opaque) values.push_back(alpha);
            values.push_back(float(random(7)) * alpha);
            samples.push_back({depth_of(lens, c), values, float(random(8) - 0.5), float(random(9) - 0.5)});
        }
        std::ranges::sort(samples, {}, &Sample::z);
        return samples;
    });
}

double largest_difference(const Image &a, const Image &b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        largest = std::max(largest, std::abs(double(a.values[i]) - double(b.values[i])));
    return largest;
}

} // namespace sparselens
