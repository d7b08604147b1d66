#include "gpu/warp/prefix_sums.h"

#include "base/grid.h"
#include "kernels/warp_layout.h"

#include <array>
#include <cstdint>
#include <span>

namespace sparselens::gpu {

namespace {

constexpr std::uint32_t code[] = {
#include <prefix_sums.comp.inc>
};
constexpr std::size_t chunk = warp_kernel::threads * warp_kernel::summed_at_once;

} // namespace

PrefixSums::PrefixSums(Device &device)
    : device_(device), program_(device.program("sums", code, 2, 2 * sizeof(std::uint32_t))) {}

void PrefixSums::run(const Buffer &numbers, std::size_t count) {
    const std::size_t chunks = pieces_of(count, chunk);
    device_.make_room(totals_, std::array{chunks * sizeof(std::uint32_t)});
    for (const std::uint32_t run : {0u, 1u}) {
        const std::array push{std::uint32_t(count), run};
        device_.run(program_, std::array{numbers, totals_[0]}, std::as_bytes(std::span(push)),
                    {std::uint32_t(chunks), 1, 1});
    }
}

} // namespace sparselens::gpu
