#include "dof/lens/cell_rows.h"

#include "base/for_processors.h"
#include "kernels/lens_rules.h"

#include <algorithm>
#include <array>

namespace sparselens {

namespace {

constexpr int half = 32;
constexpr std::array<std::uint32_t, half> one_bit = [] {
    std::array<std::uint32_t, half> bits{};
    for (std::size_t n = 0; n < half; ++n) bits[n] = std::uint32_t{1} << n;
    return bits;
}();

// Without a branch.
std::uint32_t bit_if(bool is_set, std::size_t n) { return (0 - std::uint32_t(is_set)) & one_bit[n]; }

[[gnu::always_inline]] inline std::uint32_t zeros_of_half(const std::uint64_t *keys) {
    std::uint32_t zeros = 0;
    for (std::size_t n = 0; n < half; ++n) zeros |= bit_if(kernels::upper_of(keys[n]) == 0, n);
    return zeros;
}

[[gnu::always_inline]] inline std::uint32_t far_behind_of_half(const float *depths, std::ptrdiff_t stride) {
    std::uint32_t far = 0;
    for (std::ptrdiff_t n = 0; n < std::ptrdiff_t(half); ++n) {
        const float *depth = depths + n;
        const float sides = std::max(std::min(depth[-1], depth[1]), std::min(depth[-stride], depth[stride])),
                    corners = std::max(std::min(depth[-stride - 1], depth[stride + 1]),
                                       std::min(depth[-stride + 1], depth[stride - 1]));
        far |= bit_if(std::max(sides, corners) > depth[0] + kernels::behind_crack_px, std::size_t(n));
    }
    return far;
}

} // namespace

FOR_PROCESSORS std::uint64_t zeros_of(const std::uint64_t *keys) {
    return std::uint64_t{zeros_of_half(keys + half)} << half | zeros_of_half(keys);
}

FOR_PROCESSORS void depths_of(std::span<const std::uint64_t> keys, float *depths) {
    const std::size_t count = keys.size(); // local copies rule out aliasing
    const std::uint64_t *key = keys.data();
    for (std::size_t i = 0; i < count; ++i) depths[i] = kernels::depth_of(kernels::upper_of(key[i]));
}

FOR_PROCESSORS std::uint64_t far_behind(const float *depths, std::ptrdiff_t stride) {
    return std::uint64_t{far_behind_of_half(depths + half, stride)} << half |
           far_behind_of_half(depths, stride);
}

} // namespace sparselens
