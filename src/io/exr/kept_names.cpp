#include "io/exr/kept_names.h"

#include "base/channel_names.h"
#include "io/exr/header_values.h"

#include <ImfStringVectorAttribute.h>

#include <set>

namespace sparselens {

void set_kept_names(Imf::Header &header, const KeptNames &names) {
    if (header.find(kept_names_attribute) != header.end())
        header = without_attribute(header, kept_names_attribute);
    Imf::StringVector pairs;
    for (const auto &[known, in_file] : names) pairs.insert(pairs.end(), {known, in_file});
    if (!pairs.empty()) header.insert(kept_names_attribute, Imf::StringVectorAttribute(pairs));
}

void name_colours(std::span<Channel> channels, Imf::Header &header) {
    const std::vector<std::string> known = names_of_colours(channels);
    KeptNames kept;
    for (std::size_t k = 0; k < channels.size(); ++k)
        if (channels[k].name != known[k]) {
            kept[known[k]] = channels[k].name;
            channels[k].name = known[k];
        }
    set_kept_names(header, kept);
}

std::vector<Channel> by_kept_names(std::span<const Channel> channels, const Imf::Header &metadata) {
    std::vector<Channel> named(channels.begin(), channels.end());
    const auto *attribute = metadata.findTypedAttribute<Imf::StringVectorAttribute>(kept_names_attribute);
    if (!attribute) return named;
    std::set<std::string> taken;
    for (const Channel &channel : channels) taken.insert(channel.name);
    const Imf::StringVector &pairs = attribute->value();
    for (std::size_t i = 0; i + 1 < pairs.size(); i += 2)
        if (const std::size_t k = find_channel(channels, pairs[i]);
            k != npos && !taken.contains(pairs[i + 1])) {
            taken.insert(pairs[i + 1]);
            named[k].name = pairs[i + 1];
        }
    return named;
}

} // namespace sparselens
