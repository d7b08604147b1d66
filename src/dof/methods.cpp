#include "dof/methods.h"

#include "base/matte.h"
#include "base/parallel.h"
#include "deep/build.h"
#include "deep/channel_alpha.h"
#include "dof/lens/beyond/frame_extension.h"
#include "dof/merge_layers.h"
#include "dof/selective/selective.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

namespace sparselens {

namespace {

Image by_lens(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window, const GatherOptions &options,
              Progress &progress) {
    const double tolerance = options.layer_tolerance;
    const auto gather = [&](const Ldi &one, const LensGatherOptions &by) {
        return lens_gather(one, lens, window, by, progress);
    };
    const auto gather_one = [&]<typename AnyLdi>(AnyLdi &&one) {
        if (tolerance == 0 || !can_merge_layers(one))
            return gather_beyond(std::forward<AnyLdi>(one), lens, window, options, gather);
        const double scale = disparity_scale(lens.radius, lens.focal_px);
        return gather_beyond(merge_layers(std::forward<AnyLdi>(one), scale, tolerance), lens, window, options,
                             gather);
    };
    return composited(
        ldi, [&](const Ldi &one) { return gather_one(one); },
        [&](Ldi &&one) { return gather_one(std::move(one)); });
}

Image by_selective(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                   const GatherOptions &options, Progress &progress) {
    return composited(ldi, [&](const Ldi &one) {
        return crop(selective_gather(one, lens, {options.layers, options.lens.device}, progress), window);
    });
}

Ldi without_mattes(Ldi ldi) {
    for (std::size_t k = ldi.channels.size(); k-- > 0;)
        if (is_in_matte(ldi.channels[k])) {
            ldi.channels.erase(ldi.channels.begin() + std::ptrdiff_t(k));
            ldi.values.erase(ldi.values.begin() + std::ptrdiff_t(k));
        }
    return ldi;
}

std::vector<GatherMethod> &table() {
    static std::vector<GatherMethod> methods{
        {"lens", "decides for every point of the lens what hides what", true, true, by_lens},
        {"selective", "blurs a few layers per pixel, the published method", true, false, by_selective}};
    return methods;
}

} // namespace

// Cryptomattes are always gathered by the lens gather, because the other methods only blend.
Image GatherMethod::gather(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                           const GatherOptions &options, Progress &progress) const {
    if (std::ranges::none_of(ldi.channels, is_in_matte)) return light(ldi, lens, window, options, progress);
    const Image lit = light(without_mattes(ldi), lens, window, options, progress);
    const Image mattes =
        gather_beyond(ldi, lens, window, options, [&](const Ldi &all, const LensGatherOptions &by) {
            return gather_mattes(all, lens, window, by, progress);
        });
    Image all(lit.windows, ldi.channels);
    for (std::size_t k = 0; k < all.channels.size(); ++k) {
        const Image &from = is_in_matte(all.channels[k]) ? mattes : lit;
        std::ranges::copy(from.plane(find_channel(from.channels, all.channels[k].name)),
                          all.plane(k).begin());
    }
    return all;
}

std::span<const GatherMethod> gather_methods() { return table(); }

bool join_gather_methods(const GatherMethod &method) {
    table().push_back(method);
    return true;
}

namespace {

constexpr std::size_t ids_at_once = 32; // each is a channel, which takes memory

// The ids of a matte that cover something, in the order of their bits.
std::vector<float> ids_of(const Ldi &ldi, const Matte &matte) {
    std::vector<std::uint32_t> bits;
    for (const Matte::Rank &rank : matte.ranks) {
        const std::vector<float> &ids = ldi.values[rank.id], &coverage = ldi.values[rank.coverage];
        std::optional<std::uint32_t> last;
        for (std::size_t i = 0; i < ids.size(); ++i) {
            const auto id = std::bit_cast<std::uint32_t>(ids[i]);
            if (!(coverage[i] > 0) || id == last) continue; // neighbours often show one object
            bits.push_back(id);
            last = id;
        }
        std::ranges::sort(bits);
        bits.erase(std::unique(bits.begin(), bits.end()), bits.end());
    }
    std::vector<float> ids;
    for (const std::uint32_t id : bits) ids.push_back(std::bit_cast<float>(id));
    return ids;
}

// The samples of the LDI with only its coverage.
Ldi bare(const Ldi &ldi) {
    Ldi one = without_channels(ldi);
    if (ldi.alpha() == npos) return one;
    one.channels = {ldi.channels[ldi.alpha()]};
    one.values = {ldi.values[ldi.alpha()]};
    return one;
}

std::vector<float> coverage_of_id(const Ldi &ldi, const Matte &matte, float id) {
    std::vector<float> sum(ldi.samples());
    parallel_ranges(sum.size(), 65536, [&](std::size_t begin, std::size_t end) {
        for (const Matte::Rank &rank : matte.ranks)
            for (std::size_t i = begin; i < end; ++i)
                if (std::bit_cast<std::uint32_t>(ldi.values[rank.id][i]) == std::bit_cast<std::uint32_t>(id))
                    sum[i] += ldi.values[rank.coverage][i];
    });
    return sum;
}

// Adds how much the lens sees of these ids to `seen`, for each pixel of the window.
void gather_ids(const Ldi &ldi, const Matte &matte, std::span<const float> ids, const ThinLens &lens,
                const Imath::Box2i &window, const LensGatherOptions &options, Progress &progress,
                std::vector<IdCoverage> &seen) {
    Ldi one = bare(ldi);
    const std::size_t first = one.channels.size();
    for (std::size_t n = 0; n < ids.size(); ++n) {
        one.channels.push_back({fmt::format("id{}", n), PixelType::float32, ChannelKind::data});
        one.values.push_back(coverage_of_id(ldi, matte, ids[n]));
    }
    const Image picture = lens_gather(one, lens, window, options, progress);
    parallel_ranges(seen.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = 0; n < ids.size(); ++n) {
            const std::span<const float> plane = picture.plane(first + n);
            for (std::size_t i = begin; i < end; ++i) seen[i].add(ids[n], double(plane[i]));
        }
    });
}

std::vector<Channel> matte_channels(const Ldi &ldi) {
    std::vector<Channel> channels;
    std::ranges::copy_if(ldi.channels, std::back_inserter(channels), is_in_matte);
    return channels;
}

} // namespace

Image gather_mattes(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                    const LensGatherOptions &options, Progress &progress) {
    LensGatherOptions by = options;
    by.keeps_sums = true;
    by.watch = nullptr;
    by.chosen = nullptr;
    Windows windows = ldi.windows;
    windows.data = window;
    Image out(windows, matte_channels(ldi));
    const std::vector<Matte> in_ldi = find_mattes(ldi.channels), in_picture = find_mattes(out.channels);
    for (std::size_t m = 0; m < in_ldi.size(); ++m) {
        std::vector<IdCoverage> seen(windows.pixels());
        const std::vector<float> ids = ids_of(ldi, in_ldi[m]);
        for (std::size_t first = 0; first < ids.size(); first += ids_at_once)
            gather_ids(ldi, in_ldi[m],
                       std::span(ids).subspan(first, std::min(ids_at_once, ids.size() - first)), lens, window,
                       by, progress, seen);
        for (std::size_t i = 0; i < seen.size(); ++i) {
            seen[i].limit(); // cells may exceed the range
            const auto pairs = seen[i].ranked();
            for (std::size_t r = 0; r < std::min(pairs.size(), in_picture[m].ranks.size()); ++r) {
                out.plane(in_picture[m].ranks[r].id)[i] = pairs[r].id;
                out.plane(in_picture[m].ranks[r].coverage)[i] = float(pairs[r].coverage);
            }
        }
    }
    return out;
}

} // namespace sparselens
