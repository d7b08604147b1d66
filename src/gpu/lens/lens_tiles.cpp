#include "gpu/lens/lens_tiles.h"

#include "base/grid.h"
#include "base/parallel.h"
#include "gpu/lens/stripe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

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
        if (buffers_[part].bytes < now[part].size())
            buffers_[part] = buffer_for(device, now[part].size()), there = {};
        const std::vector<ByteRange> changed = changes(there, now[part]);
        device.upload(buffers_[part], now[part], changed);
        for (const ByteRange &range : changed) copied += range.end - range.begin;
    }
    stripe_ = std::move(stripe);
    return copied;
}

std::vector<Buffer> StripeBuffers::bindings(const Buffer &values, const Buffer &known,
                                            const Buffer &sums) const {
    std::vector<Buffer> all = buffers_;
    if (stripe_.shown.empty()) all.back() = all[cocs];
    all.insert(all.end(), {values, known, sums});
    return all;
}

namespace {

constexpr std::uint32_t code[] = {
#include <lens_tile.comp.inc>
};

// Tests of a sample by a lens point that are submitted at once. Operating systems end work that takes seconds.
constexpr double work_at_once = 2e9;
constexpr double turns_in_pass = 1e6; // of loops, for the same reason
// Threads of a work group. In software, threads that have nothing to do cost as much as the others.
std::uint32_t threads_on(const Device &device) { return device.info().kind == Kind::software ? 32 : 256; }

// Lens points that a work group takes at once, by its shared memory (tile_data.glsl). More than four gain little.
std::uint32_t points_at_once(const Device &device, std::uint32_t rules) {
    const std::size_t cells = ((rules & lens_kernel::images) != 0 ? 2 : 1) * lens_kernel::cells,
                      of_point = cells * sizeof(std::uint64_t) + lens_kernel::chunk * sizeof(std::uint32_t),
                      others = threads_on(device) * 3 * sizeof(std::uint32_t) + 64;
    return std::uint32_t(
        std::clamp((device.shared_bytes() - others) / of_point, std::size_t{1}, std::size_t{4}));
}

// Sorts lens points so that each group of `points` consecutive ones lies close together: in bands from side to side of
// the lens, back and forth. Points without weight fill up the last group.
std::vector<LensSample> in_groups(std::span<const LensSample> lens, std::size_t points) {
    std::vector<LensSample> all(lens.begin(), lens.end());
    const auto [top, bottom] = std::ranges::minmax(all, {}, &LensSample::y);
    const float bands = std::sqrt(float(all.size()) / float(points)), high = (bottom.y - top.y) / bands;
    const auto place = [&, first = top.y](const LensSample &p) {
        const float band = high > 0 ? std::floor((p.y - first) / high) : 0;
        return std::pair(band, std::fmod(band, 2.0f) > 0 ? -p.x : p.x);
    };
    std::ranges::stable_sort(all, {}, place);
    LensSample none = all.back();
    none.weight = 0;
    all.resize(pieces_of(all.size(), points) * points, none);
    return all;
}

// Tests of a sample by a lens point that one of the tile's passes takes.
double work_of(const Stripe &stripe, const lens_kernel::Tile &tile) {
    double samples = 0;
    for (const std::uint32_t partial : tile.partial_count) samples += partial;
    for (std::uint32_t n = 0; n < tile.block_count; ++n) {
        const lens_kernel::Block &block = stripe.blocks[stripe.block_lists[tile.blocks + n]];
        samples += block.opaque_end - block.begin;
    }
    return samples * std::min(tile.lens_count, tile.lens_in_pass);
}

std::uint32_t passes_of(const Stripe &stripe) {
    std::uint32_t passes = 1;
    for (const lens_kernel::Tile &tile : stripe.tiles)
        passes = std::max(passes, pieces_of(tile.lens_count, tile.lens_in_pass));
    return passes;
}

} // namespace

const Program &LensTilesOnDevice::program_for(std::uint32_t rules, std::uint32_t points) {
    if (const auto made = programs_.find(rules); made != programs_.end()) return made->second;
    const std::array constants{threads_on(device_), points, rules};
    return programs_.emplace(rules, device_.program("lens", code, 19, sizeof(lens_kernel::Push), constants))
        .first->second;
}

void LensTilesOnDevice::gather(const GatherScene &scene, std::span<const TileTask> all,
                               const std::function<void(std::size_t, const TilePicture &)> &done) {
    const std::uint32_t rules = rules_of(scene, all), points = points_at_once(device_, rules);
    std::map<const LensSample *, std::vector<LensSample>> lens; // by those of the tasks
    std::vector<TileTask> taken;
    std::vector<std::size_t> numbers; // the number of each task among all tasks
    for (std::size_t n = 0; n < all.size(); ++n) {
        if (turns_of(scene, all[n]) > device_.most_turns()) {
            ++worker_.report.on_cpu["more steps than the device takes"];
            continue;
        }
        taken.push_back(all[n]);
        numbers.push_back(n);
        std::vector<LensSample> &grouped = lens[all[n].lens.data()];
        if (grouped.empty()) grouped = in_groups(all[n].lens, points);
        taken.back().lens = grouped;
    }
    const std::span<const TileTask> tasks = taken;
    const Program &program = program_for(rules, points);
    const auto fit = [&](std::size_t begin, std::size_t most, std::size_t bytes) {
        return tasks_that_fit(scene, tasks.subspan(begin, most), bytes);
    };
    const auto work = [&](std::size_t begin, std::size_t count) -> const char * {
        StripeBuffers buffers = std::exchange(buffers_, {});
        const bool whole = count == tasks.size() && fits_whole(scene, tasks, worker_.buffer_bytes());
        if (!whole) buffers = {};
        worker_.report.uploaded +=
            buffers.bring(device_, make_stripe(scene, tasks.subspan(begin, count), whole, points,
                                               std::min(turns_in_pass, device_.most_turns())));
        gather_stripe(scene, program, buffers,
                      [&](std::size_t t, const TilePicture &picture) { done(numbers[begin + t], picture); });
        if (whole) buffers_ = std::move(buffers);
        return nullptr;
    };
    worker_.by_stripes(tasks.size(), 1, fit, work);
}

void LensTilesOnDevice::gather_stripe(const GatherScene &scene, const Program &program,
                                      const StripeBuffers &in,
                                      const std::function<void(std::size_t, const TilePicture &)> &done) {
    const std::size_t tiles = in.stripe().tiles.size(), groups = scene.colours.groups,
                      all = tiles * tile_pixels * groups;
    const Buffer values = device_.buffer(all * 4 * sizeof(float)),
                 known = device_.buffer(all * sizeof(float));
    const std::uint32_t passes = passes_of(in.stripe());
    const Buffer sums = device_.buffer(passes > 1 ? all * 8 * sizeof(float) : 0);
    for (std::uint32_t pass = 0; pass < passes; ++pass)
        run(program, in.stripe(), pass, scene, in.bindings(values, known, sums));
    std::vector<float> value(all * 4), knowns(all);
    device_.download(std::as_writable_bytes(std::span(value)), values);
    device_.download(std::as_writable_bytes(std::span(knowns)), known);
    parallel_for(tiles, [&](std::size_t t) {
        done(t, {&value[t * tile_pixels * 4], &knowns[t * tile_pixels], groups, tiles * tile_pixels * 4});
    });
}

void LensTilesOnDevice::run(const Program &program, const Stripe &stripe, std::uint32_t pass,
                            const GatherScene &scene, std::span<const Buffer> buffers) {
    const auto tiles = std::uint32_t(stripe.tiles.size());
    for (std::uint32_t first = 0, end = 0; first < tiles; first = end) {
        for (double work = 0; end < tiles && (end == first || work < work_at_once); ++end)
            work += work_of(stripe, stripe.tiles[end]);
        const lens_kernel::Push push{first, tiles, std::uint32_t(stripe.alphas.size()), pass,
                                     float(scene.held_out.depth_at_1)};
        device_.run(program, buffers, std::as_bytes(std::span(&push, 1)),
                    {lens_kernel::quarters * (end - first), std::uint32_t(scene.colours.groups), 1});
    }
}

} // namespace sparselens::gpu
