#include "deep/flatten.h"

#include "base/matte.h"
#include "base/parallel.h"
#include "deep/build.h"
#include "deep/channel_alpha.h"

namespace sparselens {

namespace {

void flatten_pixel(const Ldi &ldi, const std::vector<std::size_t> &coverage, std::size_t pixel, Image &out) {
    const std::size_t plane = out.windows.pixels();
    for (std::size_t k = 0; k < ldi.channels.size(); ++k) {
        double transmittance = 1, sum = 0; // double: thousands of thin samples may add up
        for (const std::uint64_t i : ldi.pixel(pixel)) {
            if (!(transmittance > 0)) break;
            sum += transmittance * ldi.values[k][i];
            transmittance *= 1 - double(alpha_at(ldi, coverage[k], i));
        }
        out.values[k * plane + pixel] = float(sum);
    }
}

// Copies ids from the front sample.
void flatten_ids(const Ldi &ldi, std::size_t channel, std::size_t pixel, Image &out) {
    const SampleRange samples = ldi.pixel(pixel);
    out.values[channel * out.windows.pixels() + pixel] =
        samples.empty() ? 0 : ldi.values[channel][samples.front()];
}

std::vector<std::size_t> channels_of_ids(const Ldi &ldi) {
    std::vector<std::size_t> found;
    for (std::size_t k = 0; k < ldi.channels.size(); ++k)
        if (holds_ids(ldi.channels[k])) found.push_back(k);
    return found;
}

void flatten_mattes(const Ldi &ldi, MatteSum &sums, std::size_t pixel, Image &out) {
    double transmittance = 1;
    for (const std::uint64_t i : ldi.pixel(pixel)) {
        if (!(transmittance > 0)) break;
        sums.add(transmittance, [&](std::size_t k) { return ldi.values[k][i]; });
        transmittance *= 1 - double(alpha_at(ldi, ldi.alpha(), i));
    }
    sums.take([&](std::size_t k, float value) { out.values[k * out.windows.pixels() + pixel] = value; });
}

} // namespace

Image flatten(const Ldi &ldi) {
    Image out(ldi.windows, ldi.channels);
    const std::vector<std::size_t> coverage = coverage_by_channel(ldi);
    const std::vector<std::size_t> ids = channels_of_ids(ldi);
    const std::vector<Matte> mattes = find_mattes(ldi.channels);
    const Grid grid(ldi.windows.width(), ldi.windows.height());
    parallel_for(std::size_t(grid.height()), [&](std::size_t y) {
        MatteSum sums(mattes);
        for (int x = 0; x < grid.width(); ++x) {
            const std::size_t pixel = grid.index(x, int(y));
            flatten_pixel(ldi, coverage, pixel, out);
            for (const std::size_t k : ids) flatten_ids(ldi, k, pixel, out);
            if (!mattes.empty()) flatten_mattes(ldi, sums, pixel, out);
        }
    });
    return out;
}

} // namespace sparselens
