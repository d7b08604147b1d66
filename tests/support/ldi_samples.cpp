#include "support/ldi_samples.h"

#include "base/numbers.h"
#include "deep/build.h"

#include <algorithm>

namespace sparselens {

namespace {

std::vector<Sample> coloured(const TestPixel &pixel) {
    std::vector<Sample> samples;
    for (const TestSample &s : pixel)
        samples.push_back(
            {double(s.z), {s.colour, s.colour / 2, s.colour / 4, s.alpha}, s.dx, s.dy, s.z_back, s.weight});
    return samples;
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

Ldi make_ldi(const Windows &windows, const std::vector<Channel> &channels,
             const std::function<std::vector<Sample>(int x, int y)> &samples_at) {
    Ldi ldi;
    ldi.windows = windows;
    ldi.channels = channels;
    ldi.values.resize(channels.size());
    ldi.begin.push_back(0);
    bool volumes = false, images = false, solids = false;
    for (int y = windows.data.min.y; y <= windows.data.max.y; ++y)
        for (int x = windows.data.min.x; x <= windows.data.max.x; ++x) {
            for (const Sample &s : samples_at(x, y)) {
                volumes |= s.z_back != 0;
                images |= s.image_z != 0;
                solids |= s.solid != 0;
                ldi.solid.push_back(float(s.solid));
                ldi.image_z.push_back(float(s.image_z == 0 ? s.z : s.image_z));
                ldi.z.push_back(float(s.z));
                ldi.z_back.push_back(s.z_back == 0 ? float(s.z) : s.z_back);
                ldi.dx.push_back(s.dx);
                ldi.dy.push_back(s.dy);
                ldi.weight.push_back(s.weight);
                for (std::size_t k = 0; k < channels.size(); ++k) ldi.values[k].push_back(s.values[k]);
            }
            ldi.begin.push_back(ldi.z.size());
        }
    if (!volumes) ldi.z_back.clear();
    if (!images) ldi.image_z.clear();
    if (!solids) ldi.solid.clear();
    return ldi;
}

Ldi ldi_of(const std::vector<TestPixel> &pixels) {
    return make_ldi(windows_of_size(int(pixels.size()), 1), rgba_channels(),
                    [&](int x, int) { return coloured(pixels[std::size_t(x)]); });
}

TestPixel samples_of(const Ldi &ldi, std::size_t pixel) {
    TestPixel samples;
    for (const std::uint64_t i : ldi.pixel(pixel)) {
        const MergedSample at = sample_at(ldi, i);
        samples.push_back({at.z, ldi.values[0][i], ldi.values[3][i], at.z_back, at.weight, at.dx, at.dy});
    }
    return samples;
}

Ldi random_ldi(const RandomLdi &how) {
    Numbers numbers(how.seed);
    return make_ldi(windows_of_size(how.width, how.height), rgba_channels(), [&](int, int) {
        TestPixel pixel(std::size_t(numbers.below(how.most_samples + 1)));
        for (TestSample &s : pixel) s = random_sample(how, numbers);
        if (!how.shuffled) std::ranges::stable_sort(pixel, {}, &TestSample::z);
        return coloured(pixel);
    });
}

double random_unit(int a, int b, std::uint32_t stream) {
    return unit_interval(mix_bits(std::uint32_t(a), mix_bits(std::uint32_t(b), stream)));
}

} // namespace sparselens
