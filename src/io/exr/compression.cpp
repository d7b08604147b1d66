#include "io/exr/compression.h"

#include "base/channel_kind.h"
#include "base/error.h"
#include "base/text.h"

#include <ImfPartType.h>
#include <OpenEXRConfig.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

namespace sparselens {

namespace {

constexpr std::array methods {
    NamedCompression{"none", Imf::NO_COMPRESSION, true, true},
        NamedCompression{"rle", Imf::RLE_COMPRESSION, true, true},
        NamedCompression{"zips", Imf::ZIPS_COMPRESSION, true, true},
        NamedCompression{"zip", Imf::ZIP_COMPRESSION, false, true},
        NamedCompression{"piz", Imf::PIZ_COMPRESSION, false, true},
        NamedCompression{"pxr24", Imf::PXR24_COMPRESSION, false, false},
        NamedCompression{"b44", Imf::B44_COMPRESSION, false, true}, // lossy for halves only
        NamedCompression{"b44a", Imf::B44A_COMPRESSION, false, true},
        NamedCompression{"dwaa", Imf::DWAA_COMPRESSION, false, false},
        NamedCompression{"dwab", Imf::DWAB_COMPRESSION, false, false},
#if OPENEXR_VERSION_MAJOR > 3 || OPENEXR_VERSION_MINOR >= 4
        NamedCompression{"htj2k256", Imf::HTJ2K256_COMPRESSION, false, true},
        NamedCompression{"htj2k32", Imf::HTJ2K32_COMPRESSION, false, true},
#endif
#if OPENEXR_VERSION_MAJOR > 3 || OPENEXR_VERSION_MINOR >= 5
        NamedCompression{"lj2k", Imf::LJ2K_COMPRESSION, false, false},
        NamedCompression{"zstd", Imf::ZSTD_COMPRESSION, true, true},
#endif
};

// ZSTD takes as long as ZIPS, and LDIs are 15 % smaller.
#if OPENEXR_VERSION_MAJOR > 3 || OPENEXR_VERSION_MINOR >= 5
constexpr Imf::Compression usual_deep = Imf::ZSTD_COMPRESSION;
#else
constexpr Imf::Compression usual_deep = Imf::ZIPS_COMPRESSION;
#endif

const NamedCompression *method_of(Imf::Compression value) {
    const auto found = std::ranges::find(methods, value, &NamedCompression::value);
    return found == methods.end() ? nullptr : &*found;
}

template <typename Chosen>
std::string names_of(const Chosen &chosen, const std::string &separator = ", ") {
    std::vector<std::string> names;
    for (const NamedCompression &method : methods)
        if (std::invoke(chosen, method)) names.emplace_back(method.name);
    return fmt::format("{}", fmt::join(names, separator));
}

// DWA changes the channels that are named as colours are (OpenEXR, ImfDwaCompressor.h, its rules for channels), LJ2K
// at most these, PXR24 all floats of 32 bits, B44 all halves.
bool changes(const NamedCompression &method, const Channel &channel) {
    static constexpr std::array colours{"r", "red", "g", "grn", "green", "b", "blu", "blue", "y", "ry", "by"};
    if (method.value == Imf::B44_COMPRESSION || method.value == Imf::B44A_COMPRESSION)
        return channel.type == PixelType::half;
    if (method.exact || channel.type == PixelType::uint32) return false;
    const std::string last = lower_case(channel.name.substr(channel.name.rfind('.') + 1));
    return method.value == Imf::PXR24_COMPRESSION ? channel.type == PixelType::float32
                                                  : is_among(colours, last);
}

bool is_deep(const Imf::Header &header) { return header.hasType() && Imf::isDeepData(header.type()); }

} // namespace

std::span<const NamedCompression> compressions() { return methods; }

std::string compression_names(bool deep, const std::string &separator) {
    return names_of([deep](const NamedCompression &method) { return method.deep || !deep; }, separator);
}

std::string why_ids_are_lost(Imf::Compression compression, const Channel &channel) {
    const NamedCompression *method = method_of(compression);
    if (!holds_ids(channel) || channel.type == PixelType::uint32) return {};
    if (method && changes(*method, channel))
        return fmt::format("the ids in channel {} were changed by the compression {} and mean nothing now: "
                           "write them with one of {}",
                           channel.name, method->name, names_of(&NamedCompression::exact));
    if (channel.kind == ChannelKind::matte_id && channel.type == PixelType::half)
        return fmt::format(
            "the ids in channel {} are halves, which no manifest names and several objects may "
            "share: render Cryptomattes with 32 bits",
            channel.name);
    return {};
}

std::string data_changed_by(Imf::Compression compression, std::span<const Channel> channels) {
    const NamedCompression *method = method_of(compression);
    for (const Channel &channel : channels)
        if (method && channel.kind == ChannelKind::data && changes(*method, channel)) return channel.name;
    return {};
}

Imf::Compression output_compression(bool deep, std::optional<Imf::Compression> asked, bool to_pipe,
                                    const Imf::Header &metadata, std::span<const Channel> channels) {
    const auto allowed = [deep](const NamedCompression *method) { return method && (method->deep || !deep); };
    if (asked && !allowed(method_of(*asked)))
        throw UsageError("`compression`: deep files may have " + compression_names(true, ", ") + " only");
    const auto is_float_id = [](const Channel &c) { return holds_ids(c) && c.type != PixelType::uint32; };
    const auto ids = std::ranges::find_if(channels, is_float_id);
    const auto keeps = [&](const NamedCompression *method) { return method->exact || ids == channels.end(); };
    if (asked && !keeps(method_of(*asked)))
        throw UsageError(fmt::format("`compression`: {} would destroy the ids in channel {}; use one of {}, "
                                     "or leave it out with `channels`",
                                     method_of(*asked)->name, ids->name, names_of(&NamedCompression::exact)));
    if (asked) return *asked;
    if (to_pipe) return Imf::NO_COMPRESSION;
    const NamedCompression *own = method_of(metadata.compression());
    if (is_deep(metadata) == deep && allowed(own) && keeps(own)) return own->value;
    return deep ? usual_deep : Imf::ZIP_COMPRESSION;
}

} // namespace sparselens
