#include "deep/channel_alpha.h"

#include "deep/build.h"

#include <algorithm>
#include <array>
#include <string>

namespace sparselens {

namespace {

constexpr std::array coverages{"AR", "AG", "AB"};

std::array<std::size_t, 3> coverages_of_layer(std::span<const Channel> channels, const std::string &layer) {
    std::array<std::size_t, 3> found{};
    for (std::size_t c = 0; c < found.size(); ++c) found[c] = find_channel(channels, layer + coverages[c]);
    return found;
}

// AR, AG and AB if A is missing and can be made of them.
std::array<std::size_t, 3> parts_of_missing_alpha(std::span<const Channel> channels) {
    const auto parts = coverages_of_layer(channels, "");
    const bool missing = find_channel(channels, "A") == npos;
    return missing ? parts : std::array<std::size_t, 3>{npos, npos, npos};
}

std::ptrdiff_t place_of_alpha(std::span<const Channel> channels) {
    return std::ranges::count_if(find_rgb(channels), [](std::size_t k) { return k != npos; });
}

// All spans have the same size.
void set_mean(const std::array<std::span<const float>, 3> &parts, std::span<float> mean) {
    for (std::size_t i = 0; i < mean.size(); ++i) {
        const double sum = double(parts[0][i]) + double(parts[1][i]) + double(parts[2][i]);
        mean[i] = float(sum / 3); // three equal floats give exactly that float
    }
}

Ldi of_one_coverage(const Ldi &ldi, const CoveredChannels &covered) {
    Ldi one = without_channels(ldi);
    const auto add = [&](std::size_t k) {
        if (k == npos || k == ldi.alpha() || find_channel(one.channels, ldi.channels[k].name) != npos) return;
        one.channels.push_back(ldi.channels[k]);
        one.values.push_back(ldi.values[k]);
    };
    for (const std::size_t k : find_rgb(ldi.channels)) add(k);
    for (const std::size_t k : covered.channels)
        if (k != covered.coverage) add(k);
    one.channels.push_back({"A", ldi.channels[covered.coverage].type});
    one.values.push_back(ldi.values[covered.coverage]);
    return one;
}

} // namespace

std::size_t coverage_of(std::span<const Channel> channels, std::size_t k) {
    const std::size_t alpha = find_channel(channels, "A");
    const std::string &name = channels[k].name;
    const std::size_t end_of_layer = name.rfind('.') + 1; // 0: no layer
    const std::string last = name.substr(end_of_layer);
    const auto is_last = [&](const char *c) { return last == c; };
    std::size_t c = std::size_t(std::ranges::find_if(rgb_names, is_last) - rgb_names.begin());
    if (c == 3) c = std::size_t(std::ranges::find_if(coverages, is_last) - coverages.begin());
    if (c == 3 || holds_ids(channels[k])) return alpha;
    const auto own = coverages_of_layer(channels, name.substr(0, end_of_layer));
    if (all_found(own)) return own[c];
    const auto of_picture = coverages_of_layer(channels, "");
    return all_found(of_picture) ? of_picture[c] : alpha;
}

std::vector<std::size_t> coverage_by_channel(const Ldi &ldi) {
    const std::size_t alpha = ldi.alpha();
    std::vector<std::size_t> coverage(ldi.channels.size(), alpha);
    for (std::size_t k = 0; k < coverage.size() && alpha != npos; ++k) {
        const std::size_t own = coverage_of(ldi.channels, k);
        if (own != alpha && ldi.values[own] != ldi.values[alpha]) coverage[k] = own;
    }
    return coverage;
}

void add_mean_coverage(Ldi &ldi) {
    const auto parts = parts_of_missing_alpha(ldi.channels);
    if (!all_found(parts)) return;
    std::vector<float> mean(ldi.samples());
    set_mean({ldi.values[parts[0]], ldi.values[parts[1]], ldi.values[parts[2]]}, mean);
    const std::ptrdiff_t place = place_of_alpha(ldi.channels);
    ldi.channels.insert(ldi.channels.begin() + place, {"A", ldi.channels[parts[0]].type});
    ldi.values.insert(ldi.values.begin() + place, std::move(mean));
}

void add_mean_coverage(Image &image) {
    const auto parts = parts_of_missing_alpha(image.channels);
    if (!all_found(parts)) return;
    const std::ptrdiff_t place = place_of_alpha(image.channels),
                         pixels = std::ptrdiff_t(image.windows.pixels());
    std::vector<float> mean(image.windows.pixels());
    const Image &in = image;
    set_mean({in.plane(parts[0]), in.plane(parts[1]), in.plane(parts[2])}, mean);
    const PixelType type = image.channels[parts[0]].type;
    image.channels.insert(image.channels.begin() + place, {"A", type});
    image.values.insert(image.values.begin() + place * pixels, mean.begin(), mean.end());
}

std::vector<CoveredChannels> by_coverage(const Ldi &ldi) {
    const std::vector<std::size_t> coverage = coverage_by_channel(ldi);
    std::vector<CoveredChannels> all{{ldi.alpha(), {}}};
    for (std::size_t k = 0; k < coverage.size(); ++k) {
        const auto same = std::ranges::find(all, coverage[k], &CoveredChannels::coverage);
        if (same == all.end())
            all.push_back({coverage[k], {k}});
        else
            same->channels.push_back(k);
    }
    return all;
}

Ldi with_each_coverage(const Ldi &ldi, const std::function<Ldi(std::size_t)> &make) {
    const std::vector<CoveredChannels> all = by_coverage(ldi);
    Ldi result = make(all.front().coverage);
    for (std::size_t c = 1; c < all.size(); ++c) {
        Ldi other = make(all[c].coverage);
        for (const std::size_t k : all[c].channels) result.values[k] = std::move(other.values[k]);
    }
    return result;
}

Image composited(const Ldi &ldi, const std::function<Image(const Ldi &)> &composite) {
    return composited(ldi, composite, [&](Ldi &&one) { return composite(one); });
}

Image composited(const Ldi &ldi, const std::function<Image(const Ldi &)> &composite,
                 const std::function<Image(Ldi &&)> &composite_one) {
    const std::vector<CoveredChannels> all = by_coverage(ldi);
    if (all.size() == 1) return composite(ldi);
    Image result;
    for (const CoveredChannels &covered : all) {
        const Image one = composite_one(of_one_coverage(ldi, covered));
        if (result.channels.empty()) result = Image(one.windows, ldi.channels);
        for (const std::size_t k : covered.channels) {
            const std::string &name = k == covered.coverage ? "A" : ldi.channels[k].name;
            std::ranges::copy(one.plane(find_channel(one.channels, name)), result.plane(k).begin());
        }
    }
    return result;
}

} // namespace sparselens
