#include "gpu/lens/stripe_buffers.h"

#include "base/grid.h"
#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace sparselens::gpu {

namespace {

using Bytes = std::span<const std::byte>;

// Bytes that are compared and copied at once: the colours of a block of pixels.
constexpr std::size_t page = 1024;
constexpr std::size_t cocs = 12; // index of the CoCs in parts_of()

// The parts of a stripe in the order of the shader's bindings, without the buffers that the shader writes.
std::array<Bytes, 16> parts_of(const Stripe &s) {
    const auto bytes = [](const auto &values) { return std::as_bytes(std::span(values)); };
    return {bytes(s.places),      bytes(s.uppers),        bytes(s.colours), bytes(s.blocks),
            bytes(s.block_lists), bytes(s.partial_lists), bytes(s.lens),    bytes(s.tiles),
            bytes(s.facets),      bytes(s.sets),          bytes(s.columns), bytes(s.holdout),
            bytes(s.cocs),        bytes(s.alphas),        bytes(s.solids),  bytes(s.shown)};
}

// The ranges where two arrays differ, in whole pages.
std::vector<ByteRange> changes(Bytes before, Bytes now) {
    std::vector<char> differs(pieces_of(now.size(), page));
    parallel_ranges(differs.size(), 256, [&](std::size_t first, std::size_t last) {
        for (std::size_t n = first; n < last; ++n) {
            const std::size_t begin = n * page, end = std::min(begin + page, now.size());
            differs[n] = end > before.size() || std::memcmp(&before[begin], &now[begin], end - begin) != 0;
        }
    });
    std::vector<ByteRange> ranges;
    for (std::size_t n = 0; n < differs.size(); ++n) {
        if (!differs[n]) continue;
        const std::size_t begin = n * page, end = std::min(begin + page, now.size());
        if (!ranges.empty() && ranges.back().end == begin)
            ranges.back().end = end;
        else
            ranges.push_back({begin, end});
    }
    return ranges;
}

// A buffer with some room to grow, because lists may be a little larger in the next frame.
Buffer buffer_for(Device &device, std::size_t bytes) {
    return device.buffer(std::max(bytes, std::min(bytes + bytes / 8, device.largest_buffer())));
}

} // namespace

std::size_t StripeBuffers::bring(Device &device, Stripe &&stripe) {
    const auto before = parts_of(stripe_), now = parts_of(stripe);
    std::size_t copied = 0;
    for (std::size_t part = 0; part < now.size(); ++part) {
        Bytes there = before[part];
        if (part == buffers_.size()) buffers_.push_back(buffer_for(device, now[part].size())), there = {};
        if (buffers_[part].bytes() < now[part].size())
            buffers_[part] = buffer_for(device, now[part].size()), there = {};
        const std::vector<ByteRange> changed = changes(there, now[part]);
        device.upload(buffers_[part], now[part], changed);
        for (const ByteRange &range : changed) copied += range.end - range.begin;
    }
    stripe_ = std::move(stripe);
    return copied;
}

std::vector<const Buffer *> StripeBuffers::bindings(const Buffer &values, const Buffer &known,
                                                    const Buffer &sums) const {
    std::vector<const Buffer *> all;
    for (const Buffer &buffer : buffers_) all.push_back(&buffer);
    if (stripe_.shown.empty()) all.back() = &buffers_[cocs];
    all.insert(all.begin() + 8, {&values, &known});
    all.push_back(&sums);
    return all;
}

} // namespace sparselens::gpu
