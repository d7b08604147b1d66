// A flat picture of several channels in memory: planar, in the pixel geometry of EXR.
//
// Windows are EXR's: integer pixel boxes, max inclusive, y down; pixel (i, j) covers [i, i+1) x [j, j+1) and
// its centre lies at (i + 1/2, j + 1/2). Values of channel k, row y - data.min.y, column x - data.min.x lie at
// values[(k * height + row) * width + column].
#pragma once

#include "channel_kind.h"
#include "grid.h"

#include <half.h>

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sparselens {

// A std::vector that does not clear new entries. The caller must set all of them; an entry that is not set may hold
// anything. First touching the memory takes as long as clearing it, and here the threads that set the entries share
// that work.
template <typename T>
struct DefaultInitAllocator : std::allocator<T> {
    template <typename U>
    struct rebind {
        using other = DefaultInitAllocator<U>;
    };
    using std::allocator<T>::allocator;
    template <typename U>
    void construct(U *at) {
        ::new (static_cast<void *>(at)) U;
    }
    template <typename U, typename... Values>
    void construct(U *at, Values &&...values) {
        std::construct_at(at, std::forward<Values>(values)...);
    }
};

template <typename T>
using LargeArray = std::vector<T, DefaultInitAllocator<T>>;

// How a channel is stored in a file. In memory every value is a float. An id channel (uint32) keeps its 32 bits in
// the place of the float (std::bit_cast): ids may be copied, but calculations with them are meaningless.
enum class PixelType { half, float32, uint32 };

struct Channel {
    std::string name; // the full EXR name with the layer: "R", "diffuse.R"
    PixelType type = PixelType::half;
    ChannelKind kind = ChannelKind::light;
    std::string matte = {}; // in a Cryptomatte: its name,
    int rank = 0;           // and which pair the channel belongs to
    bool operator==(const Channel &) const = default;
};

struct Windows {
    Imath::Box2i display; // the frame of the camera, which the sensor width spans
    Imath::Box2i data;    // the pixels that are stored
    float pixel_aspect = 1;

    Grid grid() const { return Grid(data); } // of the pixels that are stored, in EXR coordinates
    int width() const { return grid().width(); }
    int height() const { return grid().height(); }
    std::size_t pixels() const { return grid().size(); }
    std::size_t index(const Position &at) const { return grid().index(at); }
    std::size_t index(const std::same_as<Imath::V2i> auto &pixel) const { return grid().index(pixel); }
    Imath::V2i pixel(std::size_t index) const { return grid().pixel(index); }
    int display_width() const { return display.max.x - display.min.x + 1; }
    int display_height() const { return display.max.y - display.min.y + 1; }
    bool operator==(const Windows &) const = default;
};

// The size of a window for messages: "160x90", or "160x90 at -5,0" if it does not begin at 0,0.
std::string size_text(const Imath::Box2i &window);

// The display window and the data window are both [0, width) x [0, height).
Windows windows_of_size(int width, int height);

struct Image {
    Windows windows;
    std::vector<Channel> channels;
    LargeArray<float> values;

    Image() = default;
    Image(const Windows &windows, std::vector<Channel> channels); // all values 0

    std::span<float> plane(std::size_t channel);
    std::span<const float> plane(std::size_t channel) const;
    float &at(std::size_t channel, int x, int y); // EXR coordinates
    float at(std::size_t channel, int x, int y) const;
};

// The pixels of `data`, which must lie within the data window of the image.
Image crop(const Image &image, const Imath::Box2i &data);
Image crop(Image &&image, const Imath::Box2i &data); // returns the image itself if nothing is cut off

// The index of the channel with this name, or npos.
inline constexpr std::size_t npos = std::size_t(-1);
std::size_t find_channel(std::span<const Channel> channels, std::string_view name);

// Indices of R, G and B; npos if the channel is missing.
inline constexpr std::array rgb_names{"R", "G", "B"};
std::array<std::size_t, 3> find_rgb(std::span<const Channel> channels);

// The values of all channels.
std::vector<std::span<float>> planes_of(Image &image);

// Whether all three channels exist.
bool all_found(const std::array<std::size_t, 3> &channels);

// The channels R, G, B and A, as half.
std::vector<Channel> rgba_channels();

// Halves (16 bits) of floats, bit by bit.
inline std::uint16_t bits_of_half(float value) { return Imath::half(value).bits(); } // rounded

inline float of_half(std::uint16_t bits) { return float(Imath::half(Imath::half::FromBits, bits)); }

// Whether a half holds every bit of the value.
inline bool is_half(float value) {
    return std::bit_cast<std::uint32_t>(of_half(bits_of_half(value))) == std::bit_cast<std::uint32_t>(value);
}

// The values of one channel of a picture, bit by bit in little memory: one value if all are the same, as in the
// coverage of an opaque picture; halves if halves hold every value, as in most files; otherwise floats.
class Plane {
public:
    Plane() = default;
    Plane(Plane &&) = default; // a copy would refer to the values of the original
    Plane &operator=(Plane &&) = default;

    // Copies the values and packs them.
    static Plane packed(std::span<const float> values);
    // Refers to the values, which must outlive the plane.
    static Plane of(std::span<const float> values);

    float operator[](std::size_t i) const { return floats_ ? floats_[i & mask_] : of_half(halves_[i]); }

    // Copies the values of out.size() pixels, beginning at pixel `first`.
    void copy(std::size_t first, std::span<float> out) const;

    std::size_t bytes() const {
        return halves_.size() * sizeof(halves_[0]) + own_.size() * sizeof(float);
    } // held by this plane

private:
    std::vector<std::uint16_t> halves_;
    std::vector<float> own_;
    const float *floats_ = nullptr;      // `own_`, or values of others; null: halves
    std::size_t mask_ = ~std::size_t{0}; // 0: one value
};

} // namespace sparselens
