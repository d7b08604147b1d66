#include "gpu/warp/prefix_sum.h"

#include "base/grid.h"
#include "kernels/warp_layout.h"

namespace sparselens::gpu {

namespace {

constexpr std::uint32_t within_code[] = {
#include <warp_scan.comp.inc>
};
constexpr std::uint32_t add_code[] = {
#include <warp_scan_add.comp.inc>
};

using warp_kernel::scan_block, warp_kernel::threads;
constexpr std::size_t most_in_row = 1 << 15; // every device takes as many groups

} // namespace

std::array<std::uint32_t, 3> groups_for(std::size_t items, std::size_t per_group) {
    const std::size_t groups = std::max(pieces_of(items, per_group), std::size_t{1});
    return {std::uint32_t(std::min(groups, most_in_row)), std::uint32_t(pieces_of(groups, most_in_row)), 1};
}

PrefixSum::PrefixSum(Device &device)
    : device_(device), within_(device.program(within_code, 2, 4)), add_(device.program(add_code, 2, 4)) {}

void PrefixSum::run(Buffer &numbers, std::size_t count) {
    const std::size_t blocks = pieces_of(count, std::size_t{scan_block});
    Buffer sums = device_.buffer(blocks * 4);
    const auto push_count = std::uint32_t(count);
    const std::array<const Buffer *, 2> buffers{&numbers, &sums};
    const auto push = std::as_bytes(std::span(&push_count, 1));
    device_.run(within_, buffers, push, groups_for(count, std::size_t{scan_block}));
    if (blocks <= 1) return;
    run(sums, blocks);
    device_.run(add_, buffers, push, groups_for(count, threads));
}

} // namespace sparselens::gpu
