#include "base/image.h"

#include "base/error.h"
#include "base/parallel.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <utility>

namespace sparselens {

Windows windows_of_size(int width, int height) {
    const Imath::Box2i box({0, 0}, {width - 1, height - 1});
    return {box, box, 1};
}

namespace {
// The number of values. It throws if the picture is larger than any machine's memory, so that the size cannot wrap
// round.
std::size_t count_of(const Windows &w, std::size_t channels) {
    const double count = double(w.width()) * double(w.height()) * double(channels);
    if (count > 0x1p48)
        throw Error(fmt::format("a picture of {} x {} pixels is too large", w.width(), w.height()));
    return channels * w.pixels();
}
} // namespace

Image::Image(const Windows &windows_, std::vector<Channel> channels_)
    : windows(windows_), channels(std::move(channels_)), values(count_of(windows_, channels.size())) {
    constexpr std::size_t at_once = 1 << 16;
    // Isolated, because the caller may hold a lock that other work waits for.
    tbb::this_task_arena::isolate([this] {
        parallel_ranges(values.size(), at_once, [this](std::size_t begin, std::size_t end) {
            std::fill_n(values.begin() + std::ptrdiff_t(begin), end - begin, 0.0f);
        });
    });
}

std::span<float> Image::plane(std::size_t channel) {
    return std::span(values).subspan(channel * windows.pixels(), windows.pixels());
}

std::span<const float> Image::plane(std::size_t channel) const {
    return std::span(values).subspan(channel * windows.pixels(), windows.pixels());
}

namespace {
std::size_t index_of(const Image &image, std::size_t channel, int x, int y) {
    return channel * image.windows.pixels() + image.windows.index(x, y);
}
} // namespace

float &Image::at(std::size_t channel, int x, int y) { return values[index_of(*this, channel, x, y)]; }

float Image::at(std::size_t channel, int x, int y) const { return values[index_of(*this, channel, x, y)]; }

Image crop(const Image &image, const Imath::Box2i &data) {
    if (data == image.windows.data) return image;
    Windows windows = image.windows;
    windows.data = data;
    Image result(windows, image.channels);
    for (std::size_t k = 0; k < image.channels.size(); ++k)
        for (int y = data.min.y; y <= data.max.y; ++y)
            std::copy_n(&image.values[index_of(image, k, data.min.x, y)], windows.width(),
                        &result.values[index_of(result, k, data.min.x, y)]);
    return result;
}

Image crop(Image &&image, const Imath::Box2i &data) {
    return data == image.windows.data ? std::move(image) : crop(std::as_const(image), data);
}

std::size_t find_channel(std::span<const Channel> channels, std::string_view name) {
    for (std::size_t i = 0; i < channels.size(); ++i)
        if (channels[i].name == name) return i;
    return npos;
}

std::array<std::size_t, 3> find_rgb(std::span<const Channel> channels) {
    std::array<std::size_t, 3> found{};
    for (std::size_t k = 0; k < found.size(); ++k) found[k] = find_channel(channels, rgb_names[k]);
    return found;
}

bool all_found(const std::array<std::size_t, 3> &channels) {
    return std::ranges::find(channels, npos) == channels.end();
}

std::vector<Channel> rgba_channels() {
    return {{"R", PixelType::half}, {"G", PixelType::half}, {"B", PixelType::half}, {"A", PixelType::half}};
}

} // namespace sparselens
