// The layered depth image (LDI): any number of samples in each pixel, sorted by depth. One structure of arrays holds
// our own LDIs, deep files of other programs and flat pictures with depth (one sample per pixel).
//
// Pixel i of the data window, counted row by row (base/grid.h), owns samples [begin[i], begin[i + 1]).
// Colours are scene-linear and premultiplied by coverage. The uncovered rest of a pixel is transparent background at
// infinity.
#pragma once

#include "../base/image.h"

#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// The samples of one pixel, front to back, as their indices [from, to): for (const std::uint64_t i : ldi.pixel(p)).
struct SampleRange {
    class Iterator {
    public:
        explicit Iterator(std::uint64_t index) : index_(index) {}
        std::uint64_t operator*() const { return index_; }
        Iterator &operator++() { return ++index_, *this; }
        bool operator==(const Iterator &) const = default;

    private:
        std::uint64_t index_;
    };

    std::uint64_t from, to;

    Iterator begin() const { return Iterator(from); }
    Iterator end() const { return Iterator(to); }
    std::uint64_t size() const { return to - from; }
    bool empty() const { return from == to; }
    std::uint64_t front() const { return from; } // not for an empty range
};

struct Ldi {
    Windows windows;
    std::vector<Channel> channels;    // R, G, B, A and further layers, without Z and ldi.*
    std::vector<std::uint64_t> begin; // pixels + 1 entries, the first 0

    // One entry per sample, in pixel order.
    std::vector<float> z;      // planar depth of the front, scene units, (0, inf]
    std::vector<float> z_back; // >= z; empty if no sample has an extent (all are points)
    std::vector<float> dx, dy; // offset from the pixel centre, [-1/2, 1/2], y down; empty means 0
    std::vector<float> weight; // view samples merged into this one, > 0; empty means 1
    // Planar depth of the image in a mirror or glass, in the unit of z. It gives the CoC, while z still decides
    // occlusion. Negative if the rays would meet behind the camera, never 0. Empty: equal to z.
    std::vector<float> image_z;
    // How far 1 / z falls, in 1 / scene units, through the solid behind a sample of half coverage or more: a depth
    // range that no view saw through (warp/extend_surfaces.h). 0 if unknown; empty: unknown everywhere.
    std::vector<float> solid;
    std::vector<std::vector<float>> values; // [channel][sample]

    std::size_t samples() const { return z.size(); }
    SampleRange pixel(std::size_t i) const {
        assert(i + 1 < begin.size());
        return {begin[i], begin[i + 1]};
    }
    std::size_t alpha() const { return find_channel(channels, "A"); } // npos: all samples opaque
    double coc_z(std::uint64_t i) const { return double(image_z.empty() ? z[i] : image_z[i]); }
};

// The values of all channels.
inline std::vector<std::span<float>> planes_of(Ldi &ldi) { return {ldi.values.begin(), ldi.values.end()}; }

} // namespace sparselens
