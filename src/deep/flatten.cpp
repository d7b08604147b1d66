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
        double sum = 0;
        for_shares(ldi, coverage[k], ldi.pixel(pixel), [&](std::uint64_t i, double share) {
            if (share > 0) sum += share * ldi.values[k][i];
        });
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
    for_shares(ldi, ldi.alpha(), ldi.pixel(pixel), [&](std::uint64_t i, double share) {
        if (share > 0) sums.add(share, [&](std::size_t k) { return ldi.values[k][i]; });
    });
    sums.take([&](std::size_t k, float value) { out.values[k * out.windows.pixels() + pixel] = value; });
}

} // namespace

Image flatten(const Ldi &ldi) {
    Image out(ldi.windows, ldi.channels);
    const std::vector<std::size_t> coverage = coverage_by_channel(ldi);
    const std::vector<std::size_t> ids = channels_of_ids(ldi);
    const std::vector<Matte> mattes = find_mattes(ldi.channels);
    const ArrayGrid grid(ldi.windows.width(), ldi.windows.height());
    parallel_for(std::size_t(grid.height()), [&](std::size_t y) {
        MatteSum sums(mattes);
        for (int x = 0; x < grid.width(); ++x) {
            const std::size_t pixel = grid.index(Position(x, int(y)));
            flatten_pixel(ldi, coverage, pixel, out);
            for (const std::size_t k : ids) flatten_ids(ldi, k, pixel, out);
            if (!mattes.empty()) flatten_mattes(ldi, sums, pixel, out);
        }
    });
    return out;
}

float front_depth(const Ldi &ldi, const Imath::V2i &pixel) {
    if (!ldi.windows.data.intersects(pixel)) return 0;
    const std::size_t i = ldi.windows.index(pixel);
    return ldi.pixel(i).empty() ? 0 : ldi.z[ldi.pixel(i).front()];
}

Image front_depth(const Ldi &ldi) {
    Image depth(ldi.windows, {{"Z", PixelType::float32, ChannelKind::data}});
    for (std::size_t i = 0; i < ldi.windows.pixels(); ++i)
        depth.values[i] = ldi.pixel(i).empty() ? depth_of_nothing : ldi.z[ldi.pixel(i).front()];
    return depth;
}

View front_view(const Ldi &ldi, const std::string &name) {
    std::vector<std::size_t> from; // channels
    std::vector<Channel> channels;
    const auto take = [&](std::size_t k) {
        if (k == npos) return;
        from.push_back(k);
        channels.push_back(ldi.channels[k]);
    };
    for (const std::size_t k : find_rgb(ldi.channels)) take(k);
    take(ldi.alpha());
    View view{name, Image(ldi.windows, channels), std::vector<float>(ldi.windows.pixels())};
    for (std::size_t pixel = 0; pixel < view.z.size(); ++pixel) {
        const std::uint64_t front = ldi.begin[pixel];
        if (front == ldi.begin[pixel + 1]) continue;
        view.z[pixel] = ldi.z[front];
        for (std::size_t k = 0; k < from.size(); ++k) view.image.plane(k)[pixel] = ldi.values[from[k]][front];
    }
    return view;
}

std::vector<float> front_circles_of_confusion(const Ldi &ldi, const ThinLens &lens) {
    std::vector<float> c(ldi.windows.pixels());
    for (std::size_t i = 0; i < c.size(); ++i) {
        const SampleRange samples = ldi.pixel(i);
        c[i] = float(circle_of_confusion(lens, samples.empty() ? std::numeric_limits<double>::infinity()
                                                               : ldi.coc_z(samples.front())));
    }
    return c;
}

} // namespace sparselens
