#include "lab/trace/sampling.h"

#include "base/numbers.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace sparselens::lab {

namespace {

// Primitive polynomials and initial numbers of the dimensions after the first: S. Joe and F. Y. Kuo,
// "Constructing Sobol sequences with better two-dimensional projections", 2008, the first rows of their table.
struct Direction {
    unsigned degree, coefficients, initial[4];
};
constexpr Direction directions[SobolPoints::dimensions - 1] = {{1, 0, {1}},          {2, 1, {1, 3}},
                                                               {3, 1, {1, 3, 1}},    {3, 2, {1, 1, 1}},
                                                               {4, 1, {1, 1, 3, 3}}, {4, 4, {1, 3, 5, 13}}};

// Bit k of the index flips these bits of the coordinate, highest bit = 1/2.
std::array<std::uint32_t, 32> generator(std::size_t dimension) {
    std::array<std::uint32_t, 32> v;
    if (dimension == 0) {
        for (unsigned k = 0; k < 32; ++k) v[k] = 0x80000000u >> k;
        return v;
    }
    const Direction &d = directions[dimension - 1];
    for (unsigned k = 0; k < 32; ++k) {
        if (k < d.degree) {
            v[k] = d.initial[k] << (31 - k);
            continue;
        }
        v[k] = v[k - d.degree] ^ (v[k - d.degree] >> d.degree);
        for (unsigned i = 1; i < d.degree; ++i)
            if ((d.coefficients >> (d.degree - 1 - i)) & 1) v[k] ^= v[k - i];
    }
    return v;
}

std::uint32_t reverse_bits(std::uint32_t x) {
    x = (x >> 16) | (x << 16);
    x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
    x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
    return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

// A permutation in which each bit depends only on the bits below it and on the seed: on reversed numbers this is Owen's
// nested scrambling (S. Laine and T. Karras, "Stratified sampling for stochastic transparency", 2011; B. Burley,
// "Practical hash-based Owen scrambling", 2020), with the better mixing constants of N. Vegdahl.
std::uint32_t scramble_reversed(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// The use of each coordinate. The lens has the best pair, because it blurs most.
enum Dimension : std::size_t { lens_pair = 0, pixel_pair = 2, light_pair = 4, time = 6 };

std::vector<Imath::V2d> regular_grid(int samples) {
    const int n = int(std::lround(std::sqrt(samples)));
    std::vector<Imath::V2d> grid;
    if (n * n != samples) return grid;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) grid.emplace_back((i + 0.5) / n, (j + 0.5) / n);
    return grid;
}

} // namespace

SobolPoints::SobolPoints(std::uint32_t count) : count_(count) {
    for (std::size_t dimension = 0; dimension < dimensions; ++dimension) {
        const auto v = generator(dimension);
        auto &points = reversed_[dimension];
        points.resize(count);
        for (std::uint32_t i = 1; i < count; ++i) {
            const unsigned lowest = unsigned(std::countr_zero(i));
            points[i] = points[i & (i - 1)] ^ reverse_bits(v[lowest]);
        }
    }
}

void SobolPoints::coordinates(std::size_t dimension, std::uint32_t seed, std::uint32_t first,
                              std::span<double> out) const {
    const std::uint32_t *points = reversed_[dimension].data() + first;
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = reverse_bits(scramble_reversed(points[i], seed)) * 0x1p-32;
}

PixelSamples::PixelSamples(int count, bool regular, std::uint32_t stream)
    : points_(std::uint32_t(count)), grid_(regular ? regular_grid(count) : std::vector<Imath::V2d>()),
      stream_(stream) {}

std::uint32_t PixelSamples::seed_of(int x, int y, std::size_t dimension) const {
    return mix_bits(mix_bits(std::uint32_t(x), mix_bits(std::uint32_t(y), stream_)),
                    std::uint32_t(dimension));
}

void PixelSamples::pairs(std::size_t dimension, int x, int y, std::uint32_t first,
                         std::span<Imath::V2d> out) const {
    constexpr std::size_t run = 64;
    std::array<double, run> a, b;
    for (std::size_t begin = 0; begin < out.size(); begin += run) {
        const std::size_t n = std::min(run, out.size() - begin);
        const std::uint32_t from = first + std::uint32_t(begin);
        points_.coordinates(dimension, seed_of(x, y, dimension), from, std::span(a).first(n));
        points_.coordinates(dimension + 1, seed_of(x, y, dimension + 1), from, std::span(b).first(n));
        for (std::size_t i = 0; i < n; ++i) out[begin + i] = {a[i], b[i]};
    }
}

void PixelSamples::in_pixel(int x, int y, std::uint32_t first, std::span<Imath::V2d> out) const {
    if (grid_.empty()) return pairs(pixel_pair, x, y, first, out);
    std::copy_n(grid_.begin() + std::ptrdiff_t(first), out.size(), out.begin());
}

void PixelSamples::on_lens(int x, int y, std::uint32_t first, std::span<Imath::V2d> out) const {
    pairs(lens_pair, x, y, first, out);
}

void PixelSamples::in_time(const Exposure &exposure, int x, int y, std::uint32_t first,
                           std::span<double> out) const {
    if (exposure.instant()) {
        std::ranges::fill(out, exposure.opens);
        return;
    }
    points_.coordinates(time, seed_of(x, y, time), first, out);
    for (double &share : out) share = exposure.at(share);
}

void PixelSamples::on_light(int x, int y, std::uint32_t first, std::span<Imath::V2d> out) const {
    pairs(light_pair, x, y, first, out);
}

} // namespace sparselens::lab
