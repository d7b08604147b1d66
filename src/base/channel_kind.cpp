#include "base/channel_kind.h"

#include "base/image.h"
#include "base/text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <unordered_set>

namespace sparselens {

namespace {

struct LayerName {
    std::string layer, last; // "ViewLayer.Normal" and "X"; no layer: ""
};

LayerName split(const std::string &name) {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos) return {"", name};
    return {name.substr(0, dot), name.substr(dot + 1)};
}

std::string last_component(const std::string &layer) { return lower_case(split(layer).last); }

using Layers = std::unordered_set<std::string>;

Layers layers_with(std::string_view letter, std::span<const Channel> channels) {
    Layers layers;
    for (const Channel &channel : channels)
        if (const auto [layer, last] = split(channel.name); lower_case(last) == letter) layers.insert(layer);
    return layers;
}

Layers coloured_layers(std::span<const Channel> channels) {
    Layers layers = layers_with("g", channels);
    layers.merge(layers_with("green", channels));
    return layers;
}

// The words of a name: "VRayNormals" has v, ray and normals; "world_normal" has world and normal.
std::vector<std::string> words_of(std::string_view name) {
    const auto upper = [](char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; };
    std::vector<std::string> words;
    bool within = false;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const bool letter = std::isalpha(static_cast<unsigned char>(name[i])) != 0;
        const bool hump = i > 0 && upper(name[i]) &&
                          (!upper(name[i - 1]) || (i + 1 < name.size() && std::islower(name[i + 1]) != 0));
        if (letter && (!within || hump)) words.emplace_back();
        if (letter) words.back() += lower_case(std::string(1, name[i]));
        within = letter;
    }
    return words;
}

// Whether a word is one of a list between blanks.
bool is_in(std::string_view list, const std::string &word) {
    return list.find(' ' + word + ' ') != std::string_view::npos;
}

// Whether the name of a layer, or of a channel without a layer, says that it holds data: the whole name does (also
// after "AOV"), or one of its words does, or it is P or N with the name of a space.
bool names_data(const std::string &name) {
    static constexpr std::string_view whole =
        " n ng ns nn p pref rest point uv uvs uvw st mv mv2d mvec depth z pz "
        "zdepth wpp pworld pcam pobj nworld ncam nobj dpdu dpdv dudv hitp ";
    static constexpr std::string_view parts = " normal normals pos position positions velocity motion vector "
                                              "vectors motionvec motionvector motionvectors "
                                              "tangent tangents worldnormal worldposition ";
    static constexpr std::string_view spaces = " world camera cam object obj ref eye local ";
    std::vector<std::string> words = words_of(split(name).last);
    if (words.size() > 1 && words[0] == "aov") {
        words.erase(words.begin());
        if (words.size() == 1 && is_in(whole, words[0])) return true;
    }
    if (is_in(whole, last_component(name)) || last_component(name) == "denoising depth") return true;
    if (!words.empty() && words.back() == "uv") return true;
    if (std::ranges::any_of(words, [](const std::string &word) { return is_in(parts, word); })) return true;
    return words.size() == 2 && (words[0] == "p" || words[0] == "n") && is_in(spaces, words[1]);
}

bool is_data(const std::string &name, const Layers &with_x) {
    static constexpr std::array depths{"z", "zback"};
    static constexpr std::array coordinates{"x", "u", "v", "w"};
    const auto [layer, last] = split(name);
    const std::string lower = lower_case(last);
    if (is_among(depths, lower) || names_data(layer.empty() ? last : layer)) return true;
    if (layer.empty()) return false;
    return is_among(coordinates, lower) || (lower == "y" && with_x.contains(layer));
}

// Whether a component of a name stands for numbers of objects or materials: IndexOB in Blender (Object Index since
// 5.0), ID in Arnold, objectid in Karma. It is called for every sample, so it copies nothing.
bool is_id_word(std::string_view word) {
    static constexpr std::array<std::string_view, 12> words{
        "id",        "indexob",    "indexma",     "object index", "material index", "objectid",
        "object_id", "materialid", "material_id", "instanceid",   "instance_id",    "primid"};
    const auto same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
    return word.ends_with("ID") || std::ranges::any_of(words, [&](std::string_view one) {
               return std::ranges::equal(word, one, same);
           });
}

// Which component of the name says that the channel holds such numbers: the last one in objectid and fg.ID, the layer
// in IndexOB.X. A depth never holds them.
enum class IdWord { none, channel, layer };
IdWord id_word(std::string_view name) {
    const std::size_t dot = name.rfind('.');
    const std::string_view last = name.substr(dot + 1); // the whole name if there is no dot
    if (is_id_word(last)) return IdWord::channel;
    if (dot == name.npos || last == "Z" || last == "z") return IdWord::none;
    const std::string_view layer = name.substr(0, dot);
    return is_id_word(layer.substr(layer.rfind('.') + 1)) ? IdWord::layer : IdWord::none;
}

// Where a channel belongs in a Cryptomatte, by its name: CryptoObject01.B is the id of rank 3.
struct MattePlace {
    std::string matte;
    int rank;
    ChannelKind kind;
};

std::optional<MattePlace> matte_place(const Channel &channel, std::span<const std::string> mattes) {
    const auto [layer, last] = split(channel.name);
    const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
    if (channel.type == PixelType::uint32 || layer.size() < 3 || last.empty()) return {};
    if (!is_digit(layer.end()[-1]) || !is_digit(layer.end()[-2])) return {};
    const std::string matte = layer.substr(0, layer.size() - 2);
    const bool named = std::ranges::find(mattes, matte) != mattes.end();
    if (!named && last_component(matte).find("crypto") == std::string::npos) return {};
    static constexpr std::array letters{"r", "g", "b", "a"};
    static constexpr std::array words{"red", "green", "blue", "alpha"};
    for (int c = 0; c < 4; ++c)
        if (const std::string lower = lower_case(last);
            lower == letters[std::size_t(c)] || lower == words[std::size_t(c)])
            return MattePlace{matte, 2 * std::stoi(layer.substr(layer.size() - 2)) + c / 2,
                              c % 2 == 0 ? ChannelKind::matte_id : ChannelKind::matte_coverage};
    return {};
}

} // namespace

bool holds_ids(const Channel &channel) {
    return channel.type == PixelType::uint32 || is_in_matte(channel) ||
           (channel.kind == ChannelKind::data && id_word(channel.name) != IdWord::none);
}

bool is_in_matte(const Channel &channel) {
    return channel.kind == ChannelKind::matte_id || channel.kind == ChannelKind::matte_coverage;
}

bool is_light(const Channel &channel) { return !holds_ids(channel) && channel.kind == ChannelKind::light; }

ColourPart colour_part(const Channel &channel) {
    static constexpr std::array<std::string_view, 4> parts{"R", "G", "B", "A"};
    const std::string_view name = channel.name, last = name.substr(name.rfind('.') + 1);
    const auto found = std::ranges::find(parts, last);
    return is_light(channel) && found != parts.end() ? ColourPart(1 + (found - parts.begin()))
                                                     : ColourPart::none;
}

bool is_named(const Channel &channel, std::string_view name) {
    const std::string layer = split(channel.name).layer;
    return name == channel.name || (!layer.empty() && (name == layer || name == split(layer).last));
}

void find_kinds(std::span<Channel> channels, std::span<const std::string> mattes, const StatedKinds &stated) {
    const Layers with_x = layers_with("x", channels), coloured = coloured_layers(channels);
    const auto is_id = [&](const Channel &channel) {
        const IdWord word = id_word(channel.name);
        return channel.type != PixelType::uint32 &&
               (word == IdWord::channel ||
                (word == IdWord::layer && !coloured.contains(split(channel.name).layer)));
    };
    const auto is_among_names = [](const Channel &channel, const std::vector<std::string> &names) {
        return std::ranges::any_of(names, [&](const std::string &name) { return is_named(channel, name); });
    };
    for (Channel &channel : channels) {
        if (is_among_names(channel, stated.light))
            channel.kind = ChannelKind::light;
        else if (is_among_names(channel, stated.data))
            channel.kind = ChannelKind::data;
        else if (const auto place = matte_place(channel, mattes)) {
            channel.kind = place->kind;
            channel.matte = place->matte;
            channel.rank = place->rank;
        } else if (channel.kind == ChannelKind::light && (is_data(channel.name, with_x) || is_id(channel)))
            channel.kind = ChannelKind::data;
    }
}

std::string colour_name(std::string_view name) {
    struct Colour {
        std::string_view letter, word;
    };
    static constexpr std::array<Colour, 4> colours{
        {{"r", "red"}, {"g", "green"}, {"b", "blue"}, {"a", "alpha"}}};
    const std::size_t layer = name.rfind('.') + 1; // 0: no layer
    const std::string last = lower_case(std::string(name.substr(layer)));
    for (const auto &[letter, word] : colours)
        if (last == letter || last == word)
            return std::string(name.substr(0, layer)) + upper_case(std::string(letter));
    return std::string(name);
}

namespace {

// AR for RA, if GA and BA stand in the same layer, as some renderers name the coverage of each colour; else empty.
std::string coverage_name(const std::string &name, const std::unordered_set<std::string> &all) {
    const auto [layer, last] = split(name);
    const std::string prefix = layer.empty() ? "" : layer + ".";
    const auto is_there = [&](const char *other) { return all.contains(prefix + other); };
    const bool is_one = last == "RA" || last == "GA" || last == "BA";
    if (!is_one || !is_there("RA") || !is_there("GA") || !is_there("BA")) return {};
    return prefix + "A" + last.substr(0, 1);
}

} // namespace

std::vector<std::string> names_of_colours(std::span<const Channel> channels) {
    std::unordered_set<std::string> taken;
    for (const Channel &channel : channels) taken.insert(channel.name);
    const std::unordered_set<std::string> in_file = taken;
    std::vector<std::string> names;
    for (const Channel &channel : channels) {
        std::string name = coverage_name(channel.name, in_file);
        if (name.empty()) name = is_light(channel) ? colour_name(channel.name) : channel.name;
        names.push_back(taken.insert(name).second ? std::move(name) : channel.name);
    }
    return names;
}

namespace {

std::string prefix_of(const std::string &name) {
    const std::size_t dot = name.rfind('.');
    return dot == std::string::npos ? "" : name.substr(0, dot + 1);
}

} // namespace

std::vector<std::vector<std::size_t>> colour_layers(std::span<const Channel> channels) {
    std::vector<std::vector<std::size_t>> layers;
    std::vector<std::string> prefixes; // of layers of colours; for other channels, a name that no layer has
    for (std::size_t c = 0; c < channels.size(); ++c) {
        if (!is_light(channels[c]) || channels[c].type == PixelType::uint32) continue;
        const ColourPart part = colour_part(channels[c]);
        const bool colour = part != ColourPart::none && part != ColourPart::coverage;
        const std::string prefix = colour ? prefix_of(channels[c].name) : channels[c].name + "/";
        const auto found = std::ranges::find(prefixes, prefix);
        if (found == prefixes.end()) {
            prefixes.push_back(prefix);
            layers.push_back({c});
        } else {
            layers[std::size_t(found - prefixes.begin())].push_back(c);
        }
    }
    return layers;
}

} // namespace sparselens
