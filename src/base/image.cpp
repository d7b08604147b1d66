#include "base/image.h"

#include "base/error.h"
#include "base/numbers.h"
#include "base/parallel.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cassert>
#include <cstring>

namespace sparselens {

std::string size_text(const Imath::Box2i &window) {
    const Grid grid(window);
    const std::string size = fmt::format("{}x{}", grid.width(), grid.height());
    return window.min == Imath::V2i(0, 0) ? size
                                          : fmt::format("{} at {},{}", size, window.min.x, window.min.y);
}

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
    assert(channel < channels.size() && values.size() == channels.size() * windows.pixels());
    return std::span(values).subspan(channel * windows.pixels(), windows.pixels());
}

std::span<const float> Image::plane(std::size_t channel) const {
    assert(channel < channels.size() && values.size() == channels.size() * windows.pixels());
    return std::span(values).subspan(channel * windows.pixels(), windows.pixels());
}

namespace {
std::size_t index_of(const Image &image, std::size_t channel, int x, int y) {
    assert(channel < image.channels.size());
    return channel * image.windows.pixels() + image.windows.index(Imath::V2i(x, y));
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

std::vector<std::span<float>> planes_of(Image &image) {
    std::vector<std::span<float>> planes;
    for (std::size_t k = 0; k < image.channels.size(); ++k) planes.push_back(image.plane(k));
    return planes;
}

bool all_found(const std::array<std::size_t, 3> &channels) {
    return std::ranges::find(channels, npos) == channels.end();
}

std::vector<Channel> rgba_channels() {
    return {{"R", PixelType::half}, {"G", PixelType::half}, {"B", PixelType::half}, {"A", PixelType::half}};
}

namespace {

// Sets the halves if every value is 0 or a normal half, because then the bits only move. Returns false if there is any
// other value.
bool move_bits(std::span<const float> values, std::uint16_t *halves) {
    constexpr std::uint32_t sign = 0x80000000, least = 0x38800000, end = 0x47800000, lost = 0x1fff,
                            exponents = 0x38000000; // 2^-14, 2^16; bits that a half cannot hold
    std::uint32_t others = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto bits = std::bit_cast<std::uint32_t>(values[i]), magnitude = bits & ~sign;
        const bool normal = magnitude - least < end - least;
        const std::uint32_t moved = normal ? (magnitude - exponents) >> 13 : 0;
        others |= (normal ? magnitude & lost : magnitude);
        halves[i] = static_cast<std::uint16_t>((bits & sign) >> 16 | moved);
    }
    return others == 0;
}

bool as_halves(std::span<const float> values, std::uint16_t *halves) {
    if (move_bits(values, halves)) return true;
    std::ranges::transform(values, halves, bits_of_half);
    return std::ranges::all_of(values, is_half);
}

using Half4 [[gnu::vector_size(8)]] = std::uint16_t;
using Bits4 [[gnu::vector_size(16)]] = std::uint32_t;

// Converts like of_half().
template <typename Bits, typename Float>
Bits float_bits(Bits half) {
    const Bits magnitude = half & 0x7fffu, sign = (half & 0x8000u) << 16, moved = magnitude << 13;
    const Bits finite = std::bit_cast<Bits>(std::bit_cast<Float>(moved) * 0x1p112f);
    return (magnitude < 0x7c00u ? finite : moved | 0x7f800000u) | sign;
}

// Converts many at once, because the table of of_half() does not stay in the cache.
void from_halves(std::span<const std::uint16_t> halves, std::span<float> out) {
    std::size_t i = 0;
    for (; i + 4 <= halves.size(); i += 4) {
        Half4 four;
        std::memcpy(&four, &halves[i], sizeof(four));
        store4(&out[i],
               std::bit_cast<Float4>(float_bits<Bits4, Float4>(__builtin_convertvector(four, Bits4))));
    }
    for (; i < halves.size(); ++i) out[i] = std::bit_cast<float>(float_bits<std::uint32_t, float>(halves[i]));
}

} // namespace

Plane Plane::packed(std::span<const float> values) {
    Plane plane;
    const auto bits = [](float v) { return std::bit_cast<std::uint32_t>(v); };
    const bool same =
        !values.empty() && std::ranges::all_of(values, [&](float v) { return bits(v) == bits(values[0]); });
    if (same) {
        plane.own_ = {values[0]};
        plane.mask_ = 0;
        plane.floats_ = plane.own_.data();
        return plane;
    }
    constexpr std::size_t at_once = 4096;
    plane.halves_.resize(values.size());
    bool fit = true;
    for (std::size_t i = 0; i < values.size() && fit; i += at_once)
        fit = as_halves(values.subspan(i, std::min(at_once, values.size() - i)), &plane.halves_[i]);
    if (fit) return plane;
    std::vector<std::uint16_t>().swap(plane.halves_);
    plane.own_.assign(values.begin(), values.end());
    plane.floats_ = plane.own_.data();
    return plane;
}

void Plane::copy(std::size_t first, std::span<float> out) const {
    if (!floats_)
        from_halves(std::span(halves_).subspan(first, out.size()), out);
    else if (mask_ == 0)
        std::ranges::fill(out, floats_[0]);
    else
        std::copy_n(floats_ + first, out.size(), out.begin());
}

Plane Plane::of(std::span<const float> values) {
    Plane plane;
    plane.floats_ = values.data();
    return plane;
}

} // namespace sparselens
