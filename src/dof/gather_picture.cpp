#include "dof/gather_picture.h"

#include "deep/build.h"
#include "deep/channel_alpha.h"
#include "deep/flatten.h"
#include "deep/merge.h"
#include "deep/tidy.h"
#include "dof/border_reach.h"
#include "dof/lens/beyond/frame_extension.h"
#include "lens/thin_lens.h"

#include <algorithm>
#include <string>
#include <utility>

namespace sparselens {

namespace {

// Pass an Ldi&& if `ldi` may be used up, else a const Ldi&. If colours have coverages of their own, what continues
// beyond the frame is found for each coverage (methods.cpp).
template <typename AnyLdi>
Image gather_frame(AnyLdi &&ldi, const ThinLens &lens, const Imath::Box2i &gathered,
                   const GatherMethod &method, const GatherOptions &by, Progress &progress) {
    if (!method.by_lens_points || by_coverage(ldi).size() > 1)
        return method.gather(ldi, lens, gathered, by, progress);
    return gather_beyond(std::forward<AnyLdi>(ldi), lens, gathered, by,
                         [&](const Ldi &all, const LensGatherOptions &all_by) {
                             GatherOptions options = by;
                             options.beyond.reset();
                             options.lens = all_by;
                             return method.gather(all, lens, gathered, options, progress);
                         });
}

// Layers that could not be merged before are merged here, by by.layer_tolerance.
template <typename AnyLdi>
Image gather_layers(AnyLdi &&ldi, const ThinLens &lens, const Imath::Box2i &gathered,
                    const Imath::Box2i &written, const PictureOptions &options, Progress &progress) {
    const auto sharp = options.holdout ? std::optional<Holdout>(*options.holdout) : std::nullopt;
    if (lens.radius == 0 && options.gather.lens.looks.magnification == 1)
        return crop(sharp ? flatten_held_out(ldi, *sharp) : flatten(ldi), written);
    GatherOptions by = options.gather;
    by.lens.region = written;
    by.lens.holdout = sharp ? &*sharp : nullptr;
    by.layer_tolerance = merges_layers(lens, options) ? options.layer_tolerance : 0;
    return crop(gather_frame(std::forward<AnyLdi>(ldi), lens, gathered, *options.method, by, progress),
                written);
}

// If options.gather.beyond is not given, the frame is `gathered`.
PictureOptions framed(PictureOptions options, const Ldi &ldi, const ThinLens &lens,
                      const Imath::Box2i &gathered) {
    if (!options.gather.beyond && lens.radius > 0)
        options.gather.beyond = {gathered, look_beyond(ldi, lens, options.gather.lens.looks, gathered)};
    return options;
}

// Layers merged here are not merged again, which would change them by more than the tolerance.
template <typename AnyLdi>
Image gather_any(AnyLdi &&ldi, const ThinLens &lens, const Imath::Box2i &gathered,
                 const Imath::Box2i &written, PictureOptions options, Progress &progress) {
    if (options.holdout && options.holdout_defocused) {
        const Ldi &holdout = *std::exchange(options.holdout, nullptr);
        return without_holdout(
            gather_picture(with_holdout(ldi, holdout), lens, gathered, written, options, progress));
    }
    if (!merges_layers(lens, options) || !can_merge_layers(ldi)) {
        options = framed(std::move(options), ldi, lens, gathered);
        return gather_layers(std::forward<AnyLdi>(ldi), lens, gathered, written, options, progress);
    }
    Ldi merged = merge_layers(std::forward<AnyLdi>(ldi), disparity_scale(lens.radius, lens.focal_px),
                              options.layer_tolerance);
    progress.may_end();
    options.layer_tolerance = 0;
    options = framed(std::move(options), merged, lens, gathered);
    return gather_layers(std::move(merged), lens, gathered, written, options, progress);
}

// An LDI with one flattened sample in each pixel that has samples.
Ldi flattened(const Ldi &ldi) {
    const Image flat = flatten(ldi);
    Ldi out;
    out.windows = ldi.windows;
    out.channels = ldi.channels;
    out.begin = {0};
    out.begin.reserve(ldi.begin.size());
    out.z.reserve(ldi.windows.pixels());
    out.values.resize(ldi.channels.size());
    for (std::vector<float> &values : out.values) values.reserve(ldi.windows.pixels());
    for (std::size_t pixel = 0; pixel < ldi.windows.pixels(); ++pixel) {
        if (const SampleRange samples = ldi.pixel(pixel); !samples.empty()) {
            out.z.push_back(ldi.z[samples.front()]);
            for (std::size_t k = 0; k < out.values.size(); ++k) out.values[k].push_back(flat.plane(k)[pixel]);
        }
        out.begin.push_back(out.z.size());
    }
    return out;
}

} // namespace

bool merges_layers(const ThinLens &lens, const PictureOptions &options) {
    return options.layer_tolerance > 0 && lens.radius > 0 && !options.holdout &&
           options.method->by_lens_points;
}

bool can_reduce_first(const PictureOptions &options, const ThinLens &lens, bool magnifies,
                      std::span<const Channel> channels) {
    return options.method->by_lens_points && !options.holdout && !magnifies &&
           !(lens.radius == 0 && std::ranges::any_of(channels, is_in_matte));
}

bool merges_by_rows(std::span<const Channel> channels) {
    const std::size_t alpha = find_channel(channels, "A");
    if (alpha == npos || std::ranges::any_of(channels, is_in_matte)) return false;
    for (std::size_t k = 0; k < channels.size(); ++k)
        if (coverage_of(channels, k) != alpha) return false;
    return true;
}

Ldi reduced_first(Ldi rows, const ThinLens &lens, const PictureOptions &options) {
    if (lens.radius == 0) return flattened(rows);
    if (!merges_layers(lens, options) || !merges_by_rows(rows.channels)) return rows;
    return merge_layers(std::move(rows), disparity_scale(lens.radius, lens.focal_px),
                        options.layer_tolerance);
}

Image gather_picture(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &gathered,
                     const Imath::Box2i &written, const PictureOptions &options, Progress &progress) {
    return gather_any(ldi, lens, gathered, written, options, progress);
}

Image gather_picture(Ldi &&ldi, const ThinLens &lens, const Imath::Box2i &gathered,
                     const Imath::Box2i &written, const PictureOptions &options, Progress &progress) {
    return gather_any(std::move(ldi), lens, gathered, written, options, progress);
}

namespace {

const std::string layer = "holdout.";

// The channel for the holdout's coverage, beside the picture's own. Its name decides which coverage attenuates it
// behind other samples (deep/channel_alpha.h): "holdout.R" follows AR, and "holdout.share" follows A.
std::string share_of(const std::string &coverage) {
    return layer + (coverage == "A" ? "share" : coverage.substr(1));
}

// Whether the channel is A, AR, AG or AB.
bool is_coverage(const std::vector<Channel> &channels, std::size_t k) {
    return channels[k].name.find('.') == std::string::npos && coverage_of(channels, k) == k;
}

std::vector<std::string> coverage_names(const std::vector<Channel> &channels) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < channels.size(); ++k)
        if (is_coverage(channels, k)) names.push_back(channels[k].name);
    return names;
}

void add_channel(Ldi &ldi, const std::string &name, std::vector<float> values) {
    ldi.channels.push_back({name, PixelType::half});
    ldi.values.push_back(std::move(values));
}

// The samples of the holdout with the coverage channels of the picture, each twice, and nothing else.
Ldi coverage_alone(const Ldi &holdout, const std::vector<std::string> &names) {
    Ldi result = without_channels(holdout);
    for (const std::string &name : names) {
        const std::size_t own = find_channel(holdout.channels, name);
        const std::size_t from = own == npos ? holdout.alpha() : own;
        const std::vector<float> values =
            from == npos ? std::vector<float>(holdout.samples(), 1.0f) : holdout.values[from];
        add_channel(result, name, values);
        add_channel(result, share_of(name), values);
    }
    return result;
}

} // namespace

Ldi with_holdout(const Ldi &ldi, const Ldi &holdout) {
    Ldi picture = ldi;
    if (picture.alpha() == npos) add_channel(picture, "A", std::vector<float>(ldi.samples(), 1.0f));
    const std::vector<std::string> names = coverage_names(picture.channels);
    for (const std::string &name : names)
        add_channel(picture, share_of(name), std::vector<float>(ldi.samples(), 0.0f));
    const Windows windows = picture.windows;
    Ldi merged = tidy(deep_merge({std::move(picture), coverage_alone(holdout, names)}));
    merged.windows.display = windows.display;
    return merged;
}

Image without_holdout(Image picture) {
    std::vector<Channel> kept;
    for (const Channel &channel : picture.channels)
        if (!channel.name.starts_with(layer)) kept.push_back(channel);
    Image result(picture.windows, kept);
    for (std::size_t k = 0; k < kept.size(); ++k) {
        std::ranges::copy(picture.plane(find_channel(picture.channels, kept[k].name)),
                          result.plane(k).begin());
        if (!is_coverage(kept, k)) continue;
        const auto holdout =
            std::as_const(picture).plane(find_channel(picture.channels, share_of(kept[k].name)));
        const auto coverage = result.plane(k);
        for (std::size_t i = 0; i < coverage.size(); ++i)
            coverage[i] = std::max(0.0f, coverage[i] - holdout[i]); // rounding may leave less than 0
    }
    return result;
}

} // namespace sparselens
