#include "dof/defocused_holdout.h"

#include "deep/build.h"
#include "deep/channel_alpha.h"
#include "deep/merge.h"
#include "deep/tidy.h"

#include <algorithm>
#include <string>
#include <utility>

namespace sparselens {

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
