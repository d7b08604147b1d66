#include "chain/channels.h"

#include "base/channel_kind.h"
#include "base/error.h"
#include "base/matte.h"
#include "base/text.h"
#include "deep/channel_alpha.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

namespace sparselens {

namespace {

bool names(const std::string &item, const Channel &channel) {
    const std::string &name = channel.name;
    if (item == "rgba") return name == "R" || name == "G" || name == "B" || name == "A";
    return item == name || colour_name(item) == name || name.starts_with(item + ".") ||
           (is_in_matte(channel) && item == channel.matte);
}

// The layers and the Cryptomatte that hold the channel.
std::vector<std::string> holders_of(const Channel &channel) {
    std::vector<std::string> holders;
    if (is_in_matte(channel)) holders.push_back(channel.matte);
    for (std::size_t dot = channel.name.find('.'); dot != npos; dot = channel.name.find('.', dot + 1))
        holders.push_back(channel.name.substr(0, dot));
    return holders;
}

// The full name of what is asked for, which may be the last part of the name of a layer or a Cryptomatte.
std::string full_name(const std::string &item, const std::vector<Channel> &channels) {
    std::set<std::string> found;
    for (const Channel &channel : channels) {
        if (names(item, channel)) return item;
        for (const std::string &holder : holders_of(channel))
            if (holder.ends_with("." + item)) found.insert(holder);
    }
    if (found.size() > 1)
        throw UsageError(fmt::format("`channels`: '{}' is the last part of {}: give one by its full name",
                                     item, fmt::join(found, " and ")));
    return found.empty() ? item : *found.begin();
}

std::vector<std::string> names_of(const std::vector<Channel> &channels) {
    std::vector<std::string> names;
    for (const Channel &channel : channels) names.push_back(channel.name);
    return names;
}

std::vector<bool> chosen(const std::vector<Channel> &channels, const std::string &list) {
    std::vector<bool> result(channels.size(), list.empty());
    for (const std::string &asked : words_between_commas(list)) {
        const std::string item = full_name(asked, channels);
        bool found = false;
        for (std::size_t k = 0; k < channels.size(); ++k)
            if (names(item, channels[k])) found = result[k] = true;
        if (!found)
            throw UsageError(fmt::format("`channels`: no channel or layer '{}'; the file has {}", item,
                                         fmt::join(names_of(channels), ", ")));
    }
    return result;
}

} // namespace

void keep_channels(Ldi &ldi, const std::string &list) {
    std::vector<bool> keep = chosen(ldi.channels, list);
    for (std::size_t k = 0; k < keep.size(); ++k)
        if (names("rgba", ldi.channels[k])) keep[k] = true;
    for (std::size_t k = 0; k < keep.size(); ++k)
        if (const std::size_t c = coverage_of(ldi.channels, k); keep[k] && c != npos) keep[c] = true;
    for (std::size_t k = 0; k < keep.size(); ++k)
        for (std::size_t other = 0; keep[k] && is_in_matte(ldi.channels[k]) && other < keep.size(); ++other)
            if (is_in_matte(ldi.channels[other]) && ldi.channels[other].matte == ldi.channels[k].matte)
                keep[other] = true; // all pairs of a matte are ranked together
    std::size_t kept = 0;
    for (std::size_t k = 0; k < keep.size(); ++k) {
        if (!keep[k]) continue;
        std::swap(ldi.channels[kept], ldi.channels[k]);
        std::swap(ldi.values[kept++], ldi.values[k]);
    }
    ldi.channels.resize(kept);
    ldi.values.resize(kept);
}

Image chosen_channels(Image image, const std::string &list) {
    const std::vector<bool> keep = chosen(image.channels, list);
    if (std::find(keep.begin(), keep.end(), false) == keep.end()) return image;
    std::vector<Channel> channels;
    for (std::size_t k = 0; k < keep.size(); ++k)
        if (keep[k]) channels.push_back(image.channels[k]);
    Image result(image.windows, channels);
    for (std::size_t k = 0, to = 0; k < keep.size(); ++k)
        if (keep[k]) std::ranges::copy(image.plane(k), result.plane(to++).begin());
    return result;
}

std::vector<std::string> lost_matte_warnings(const Image &picture) {
    const std::size_t alpha = find_channel(picture.channels, "A");
    std::vector<std::string> warnings;
    for (const Matte &matte : find_mattes(picture.channels)) {
        double all = 0, lost = 0;
        for (std::size_t i = 0; i < picture.windows.pixels(); ++i) {
            const double covered = alpha == npos ? 1 : double(picture.plane(alpha)[i]);
            double left = covered;
            for (const Matte::Rank &rank : matte.ranks) left -= double(picture.plane(rank.coverage)[i]);
            all += covered;
            if (picture.plane(matte.ranks.back().coverage)[i] > 0) lost += std::max(left, 0.0);
        }
        if (lost > 0.01 * all)
            warnings.push_back(
                fmt::format("Cryptomatte {} lacks {:.0f} % of the coverage, because it has room "
                            "for {} objects a pixel: render it with more levels",
                            matte.name, 100 * lost / all, matte.ranks.size()));
    }
    return warnings;
}

} // namespace sparselens
