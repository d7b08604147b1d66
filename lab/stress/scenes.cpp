#include "lab/stress/scenes.h"

#include "base/numbers.h"
#include "dof/lens/lens_gather.h"
#include "lab/reference/lens_gather_reference.h"
#include "lens/lens_samples.h"

#include <algorithm>
#include <chrono>

namespace sparselens::lab::stress {

namespace {

Ldi make_ldi(const Windows &windows, std::vector<Channel> channels, std::span<const float> parts,
             const PixelAt &pixel) {
    Ldi ldi;
    ldi.windows = windows;
    ldi.channels = std::move(channels);
    ldi.values.resize(ldi.channels.size());
    ldi.begin.push_back(0);
    for (int y = windows.data.min.y; y <= windows.data.max.y; ++y)
        for (int x = windows.data.min.x; x <= windows.data.max.x; ++x) {
            for (const Sample &s : pixel(x, y)) {
                ldi.z.push_back(float(s.z));
                ldi.dx.push_back(s.dx);
                ldi.dy.push_back(s.dy);
                for (std::size_t k = 0; k < parts.size(); ++k) ldi.values[k].push_back(parts[k] * s.colour);
                ldi.values[parts.size()].push_back(s.alpha);
            }
            ldi.begin.push_back(ldi.z.size());
        }
    return ldi;
}

} // namespace

Ldi grey_ldi(const Windows &windows, const PixelAt &pixel) {
    return make_ldi(windows, {{"Y"}, {"A"}}, std::array{1.0f}, pixel);
}

Ldi colour_ldi(const Windows &windows, const PixelAt &pixel) {
    return make_ldi(windows, rgba_channels(), std::array{1.0f, 0.5f, 0.25f}, pixel);
}

ThinLens plain_lens() { return {.radius = 0.0625, .focal_px = 640, .focus = 5}; }

double depth_of(const ThinLens &lens, double coc) {
    if (std::isinf(lens.focus)) return -lens.radius * lens.focal_px / coc;
    return lens.focus / (1 - coc * lens.focus / (lens.radius * lens.focal_px));
}

float texture(int x, int y) {
    return float(unit_interval(mix_bits(std::uint32_t(x) * 7919 + 17, std::uint32_t(y))));
}

Windows window(int width, int height) { return windows_of_size(width, height); }

Imath::Box2i inner(const Windows &windows, int margin) {
    return {windows.data.min + Imath::V2i(margin), windows.data.max - Imath::V2i(margin)};
}

Image gather(const Ldi &ldi, const ThinLens &lens, StressResult &result, int lens_points) {
    Progress silent;
    const auto start = std::chrono::steady_clock::now();
    Image image = lens_gather(ldi, lens, ldi.windows.data, {.lens_samples = lens_points}, silent);
    result.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.pixels += double(ldi.windows.pixels());
    return image;
}

double off_from(const Image &image, std::size_t channel, const Imath::Box2i &box, double value) {
    double largest = 0;
    for (int y = box.min.y; y <= box.max.y; ++y)
        for (int x = box.min.x; x <= box.max.x; ++x) {
            const double off = std::abs(double(image.at(channel, x, y)) - value);
            largest = std::max(largest, std::isfinite(off) ? off : INFINITY);
        }
    return value == 0 ? largest : largest / std::abs(value);
}

double off_from(const Image &image, const Image &expected, const Imath::Box2i &box) {
    double largest = 0, scale = 0;
    for (std::size_t k = 0; k < expected.channels.size(); ++k)
        for (int y = box.min.y; y <= box.max.y; ++y)
            for (int x = box.min.x; x <= box.max.x; ++x) {
                const double off = std::abs(double(image.at(k, x, y)) - double(expected.at(k, x, y)));
                largest = std::max(largest, std::isfinite(off) ? off : INFINITY);
                scale = std::max(scale, std::abs(double(expected.at(k, x, y))));
            }
    return scale > 0 ? largest / scale : largest;
}

double sum_of(const Image &image, std::size_t channel) {
    double sum = 0;
    for (const float v : image.plane(channel)) sum += double(v);
    return sum;
}

// The largest share of lens points for which rounding decides what they see; with more, the comparison would prove
// little. With 16 per pixel, this is one of them in one pixel of twenty (docs/tolerances.md, section 4).
constexpr double most_unsure = 0.05 / 16;

StressResult against_reference(const Ldi &ldi, const ThinLens &lens, int lens_points) {
    StressResult result;
    const Image image = gather(ldi, lens, result, lens_points);
    const auto points = disc_lens_samples(std::size_t(lens_points), lens.pixel_aspect);
    const ReferencePicture expected = lens_gather_reference(ldi, lens, ldi.windows.data, points);
    long double largest = 0, scale = 0, sum = 0, expected_sum = 0;
    const std::size_t pixels = ldi.windows.pixels();
    for (std::size_t i = 0; i < expected.values.size(); ++i) {
        const ReferenceValue &value = expected.values[i];
        largest = std::max(largest, value.off(image.values[i]));
        scale = std::max(scale, std::abs(value.value));
        if (i < pixels && expected.sure[i]) sum += image.values[i], expected_sum += value.value;
    }
    result.error =
        expected.unsure_points <= most_unsure ? double(scale > 0 ? largest / scale : largest) : INFINITY;
    if (expected_sum > 0) result.energy = double((sum - expected_sum) / expected_sum);
    return result;
}

StressResult constant_plane(const ThinLens &lens, double z, double colour, int width, int height) {
    StressResult result;
    const Ldi ldi = colour_ldi(window(width, height), [&](int, int) { return Pixel{{z, float(colour)}}; });
    const Image image = gather(ldi, lens, result, 0);
    const double value = double(float(colour));
    result.error =
        std::max(off_from(image, 0, image.windows.data, value), off_from(image, 3, image.windows.data, 1));
    result.energy = sum_of(image, 0) / (value * result.pixels) - 1;
    return result;
}

} // namespace sparselens::lab::stress

namespace sparselens::lab {

double times_plain(const StressResult &result) {
    static const StressResult plain = [] {
        StressResult measured;
        const ThinLens lens = stress::plain_lens();
        const Ldi ldi = stress::grey_ldi(stress::window(256, 192), [&](int x, int y) {
            return stress::Pixel{{stress::depth_of(lens, 4), stress::texture(x, y)}};
        });
        stress::gather(ldi, lens, measured);
        measured = {};
        stress::gather(ldi, lens, measured);
        return measured;
    }();
    return result.seconds / (plain.seconds * std::max(1.0, result.pixels / plain.pixels));
}

} // namespace sparselens::lab
