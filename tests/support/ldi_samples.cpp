#include "support/ldi_samples.h"

#include "base/random.h"

#include <algorithm>

namespace sparselens {

namespace {

Ldi ldi_of(const std::vector<TestPixel> &pixels, const Windows &windows, bool volumes) {
    Ldi ldi;
    ldi.windows = windows;
    ldi.channels = rgba_channels();
    ldi.values.resize(4);
    ldi.begin.push_back(0);
    for (const TestPixel &pixel : pixels) {
        for (const TestSample &s : pixel) {
            ldi.z.push_back(s.z);
            if (volumes) ldi.z_back.push_back(s.z_back == 0 ? s.z : s.z_back);
            ldi.dx.push_back(s.dx);
            ldi.dy.push_back(s.dy);
            ldi.weight.push_back(s.weight);
            ldi.values[0].push_back(s.colour);
            ldi.values[1].push_back(s.colour / 2);
            ldi.values[2].push_back(s.colour / 4);
            ldi.values[3].push_back(s.alpha);
        }
        ldi.begin.push_back(ldi.z.size());
    }
    return ldi;
}

class Numbers {
public:
    explicit Numbers(std::uint32_t seed) : seed_(seed) {}
    double next() { return unit_interval(mix_bits(++count_, seed_)); }
    int below(int count) { return int(next() * count); }

private:
    std::uint32_t seed_, count_ = 0;
};

TestSample random_sample(const RandomLdi &how, Numbers &numbers) {
    TestSample s{float(1 + 9 * double(numbers.below(how.depths)) / how.depths)};
    s.alpha = numbers.next() < how.opaque_share ? 1 : float(numbers.next());
    s.colour = float(numbers.next()) * s.alpha;
    if (numbers.next() < how.volume_share)
        s.z_back = s.z + float(3 * double(1 + numbers.below(how.depths)) / how.depths);
    s.weight = float(1 + numbers.below(4));
    s.dx = float(numbers.next() - 0.5);
    s.dy = float(numbers.next() - 0.5);
    return s;
}

} // namespace

Ldi ldi_of(const std::vector<TestPixel> &pixels) {
    const bool volumes = std::ranges::any_of(pixels, [](const TestPixel &p) {
        return std::ranges::any_of(p, [](const auto &s) { return s.z_back != 0; });
    });
    return ldi_of(pixels, windows_of_size(int(pixels.size()), 1), volumes);
}

TestPixel samples_of(const Ldi &ldi, std::size_t pixel) {
    TestPixel samples;
    for (const std::uint64_t i : ldi.pixel(pixel))
        samples.push_back({ldi.z[i], ldi.values[0][i], ldi.values[3][i],
                           ldi.z_back.empty() ? ldi.z[i] : ldi.z_back[i], ldi.weight[i], ldi.dx[i],
                           ldi.dy[i]});
    return samples;
}

Ldi random_ldi(const RandomLdi &how) {
    Numbers numbers(how.seed);
    std::vector<TestPixel> pixels(std::size_t(how.width * how.height));
    for (TestPixel &pixel : pixels) {
        pixel.resize(std::size_t(numbers.below(how.most_samples + 1)));
        for (TestSample &s : pixel) s = random_sample(how, numbers);
        if (!how.shuffled) std::ranges::stable_sort(pixel, {}, &TestSample::z);
    }
    return ldi_of(pixels, windows_of_size(how.width, how.height), how.volume_share > 0);
}

} // namespace sparselens
