#include "lab/tests/stress/stress.h"

#include "base/numbers.h"
#include "dof/lens/lens_gather.h"
#include "lab/reference/lens_gather_reference.h"
#include "lens/lens_samples.h"

#include <algorithm>
#include <cmath>

namespace sparselens::stress {

namespace {

// The first channels are these parts of the colour; A follows.
Ldi ldi_of_parts(const Windows &windows, const std::vector<Channel> &channels,
                 const std::vector<float> &parts, const PixelAt &pixel) {
    return make_ldi(windows, channels, [&](int x, int y) {
        std::vector<Sample> samples;
        for (const Spot &spot : pixel(x, y)) {
            std::vector<float> values;
            for (const float part : parts) values.push_back(part * spot.colour);
            values.push_back(spot.alpha);
            samples.push_back({spot.z, values, spot.dx, spot.dy});
        }
        return samples;
    });
}

// The largest share of lens points for which rounding decides what they see; with more, the comparison would prove
// little. With 16 per pixel, this is one of them in one pixel of twenty (docs/tolerances.md, section 4).
constexpr double most_unsure = 0.05 / 16;

} // namespace

Ldi grey_ldi(const Windows &windows, const PixelAt &pixel) {
    return ldi_of_parts(windows, {{"V"}, {"A"}}, {1}, pixel);
}

Ldi grey_ldi(int width, int height, const PixelAt &pixel) {
    return grey_ldi(windows_of_size(width, height), pixel);
}

Ldi colour_ldi(int width, int height, const PixelAt &pixel) {
    return ldi_of_parts(windows_of_size(width, height), rgba_channels(), {1, 0.5f, 0.25f}, pixel);
}

float texture(int x, int y) {
    return float(unit_interval(mix_bits(std::uint32_t(x) * 7919 + 17, std::uint32_t(y))));
}

Image gather(const Ldi &ldi, const ThinLens &lens, int lens_points) {
    Progress silent;
    return lens_gather(ldi, lens, ldi.windows.data, {.lens_samples = lens_points}, silent);
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

double off_from(const Image &image, const Image &expected) {
    const Image same_window = crop(image, expected.windows.data);
    double largest = 0, scale = 0;
    for (std::size_t i = 0; i < expected.values.size(); ++i) {
        const double value = double(expected.values[i]),
                     off = std::abs(double(same_window.values[i]) - value);
        largest = std::max(largest, std::isfinite(off) ? off : INFINITY);
        scale = std::max(scale, std::abs(value));
    }
    return scale > 0 ? largest / scale : largest;
}

double off_plane(const Image &image, double colour, double alpha, int border) {
    Imath::Box2i box = image.windows.data;
    box.min += Imath::V2i(border);
    box.max -= Imath::V2i(border);
    return std::max(off_from(image, 0, box, colour), off_from(image, image.channels.size() - 1, box, alpha));
}

double sum_of(const Image &image, std::size_t channel) {
    double sum = 0;
    for (const float v : image.plane(channel)) sum += double(v);
    return sum;
}

Result against_reference(const Ldi &ldi, const ThinLens &lens, int lens_points) {
    const Image image = gather(ldi, lens, lens_points);
    const auto points = disc_lens_samples(std::size_t(lens_points), lens.pixel_aspect);
    const ReferencePicture expected = lens_gather_reference(ldi, lens, ldi.windows.data, points);
    EXPECT_LE(expected.unsure_points, most_unsure);
    long double largest = 0, scale = 0, sum = 0, expected_sum = 0;
    for (std::size_t i = 0; i < expected.values.size(); ++i) {
        const ReferenceValue &value = expected.values[i];
        largest = std::max(largest, value.off(image.values[i]));
        scale = std::max(scale, std::abs(value.value));
        if (i < ldi.windows.pixels() && expected.sure[i]) sum += image.values[i], expected_sum += value.value;
    }
    Result result{double(scale > 0 ? largest / scale : largest)};
    if (expected_sum > 0) result.energy = double(sum / expected_sum - 1);
    return result;
}

Result against_plane(const Image &image, double colour) {
    return {off_plane(image, colour, 1), sum_of(image, 0) / (colour * double(image.windows.pixels())) - 1};
}

Result constant_plane(const ThinLens &lens, double z, double colour, int width, int height) {
    const float value = float(colour);
    const Ldi ldi = colour_ldi(width, height, [&](int, int) { return Pixel{{z, value}}; });
    return against_plane(gather(ldi, lens, 0), double(value));
}

} // namespace sparselens::stress
