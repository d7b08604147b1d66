#include "io/exr/exr_parts.h"

#include "base/channel_kind.h"
#include "base/error.h"
#include "base/text.h"
#include "io/exr/exr_channels.h"
#include "io/exr/exr_common.h"
#include "io/exr/exr_header.h"
#include "io/files/file_stream.h"

#include <ImfStandardAttributes.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace sparselens {

namespace {

// A channel's name without the view in it, and that view, or "".
struct NameInView {
    std::string plain, view;
};

NameInView split_name(const std::string &name, const std::vector<std::string> &views) {
    for (std::size_t begin = 0, dot; (dot = name.find('.', begin)) != std::string::npos; begin = dot + 1) {
        const std::string component = name.substr(begin, dot - begin);
        if (is_among(views, component)) return {name.substr(0, begin) + name.substr(dot + 1), component};
    }
    const bool in_layer = name.find('.') != std::string::npos;
    return {name, in_layer || views.empty() ? "" : views.front()};
}

Channel channel_of(const std::string &name, const Imf::Channel &in_file) {
    const auto type = in_file.type == Imf::HALF   ? PixelType::half
                      : in_file.type == Imf::UINT ? PixelType::uint32
                                                  : PixelType::float32;
    return {name, type};
}

void name_colours(std::vector<FileChannel> &channels) {
    std::vector<Channel> plain;
    for (const FileChannel &found : channels) plain.push_back(found.channel);
    const std::vector<std::string> names = names_of_colours(plain);
    for (std::size_t k = 0; k < channels.size(); ++k)
        if (std::string &name = channels[k].channel.name; name != names[k]) {
            channels[k].kept = name;
            name = names[k];
        }
}

} // namespace

void rename(FileChannel &channel, const std::string &name) {
    std::string &kept = channel.kept;
    if (const std::size_t layer = name.rfind('.') + 1; !kept.empty() && layer > 0)
        kept = name.substr(0, layer) + kept.substr(kept.rfind('.') + 1);
    channel.channel.name = name;
}

void keep_names(Imf::Header &header, const std::vector<FileChannel> &channels) {
    KeptNames names;
    for (const FileChannel &found : channels)
        if (!found.kept.empty()) names[found.channel.name] = found.kept;
    set_kept_names(header, names);
}

std::string layer_of(const Imf::Header &header) {
    std::string name = header.hasName() ? header.name() : std::string();
    const std::string view = header.hasView() ? "." + header.view() : std::string();
    if (view.size() > 1 && name.ends_with(view)) name.resize(name.size() - view.size());
    return name;
}

bool is_beauty(const Imf::Header &header) {
    const std::string layer = layer_of(header);
    return layer.empty() || is_beauty_name(layer);
}

std::vector<std::string> views_of(const Imf::Header &header) {
    if (Imf::hasMultiView(header) && !Imf::multiView(header).empty()) return Imf::multiView(header);
    if (header.hasView() && !header.view().empty()) return {header.view()};
    const auto has = [&](const std::string &name) { return header.channels().findChannel(name) != nullptr; };
    for (const auto &[hero, other] : {std::pair("left", "right"), std::pair("right", "left")})
        if (const std::string eye = std::string(other) + "."; has("R") && has(eye + "R") &&
                                                              (has(eye + "Z") || has(eye + "depth.Z")) &&
                                                              !has(hero + std::string(".R")))
            return {hero, other};
    return {};
}

std::vector<std::string> all_views(const Imf::MultiPartInputFile &file, const std::vector<int> &numbers) {
    std::vector<std::string> all;
    for (const int part : numbers)
        for (const std::string &view : views_of(file.header(part)))
            if (!is_among(all, view)) all.push_back(view);
    return all;
}

PartsOfView parts_of_view(const Imf::MultiPartInputFile &file, const std::vector<int> &numbers,
                          const std::string &asked, const std::string &path) {
    PartsOfView parts{asked, {}};
    const auto default_view = [&](int part) {
        const std::vector<std::string> views = views_of(file.header(part));
        return views.empty() ? std::string() : views.front();
    };
    if (asked.empty() && !numbers.empty()) parts.view = default_view(numbers.front());
    for (const int part : numbers) {
        const std::vector<std::string> views = views_of(file.header(part));
        if (parts.view.empty() ? views.empty() : is_among(views, parts.view)) parts.numbers.push_back(part);
    }
    if (!asked.empty() && parts.numbers.empty()) {
        const std::vector<std::string> all = all_views(file, numbers);
        throw Error(fmt::format("{}: has no stereo view '{}' (`stereo_view`): {}", display_name(path), asked,
                                all.empty() ? std::string("it names no views")
                                            : fmt::format("its views are {}", fmt::join(all, ", "))));
    }
    return parts;
}

std::vector<FileChannel> channels_of(const Imf::Header &header, const std::string &view,
                                     const std::string &path) {
    const bool several = views_of(header).size() > 1;
    const auto views = several ? views_of(header) : std::vector<std::string>();
    std::vector<FileChannel> channels, shared;
    const Imf::ChannelList &list = header.channels();
    for (auto it = list.begin(); it != list.end(); ++it) {
        const NameInView name = split_name(it.name(), views);
        if (several && name.view != view && !name.view.empty()) continue;
        if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
            throw Error(fmt::format(
                "{}: channel {} is subsampled, as in colours stored as luminance and chroma (Y, RY, BY): "
                "render R, G and B, or convert what needs no depth (from oiiotool 2.5.8 on: oiiotool "
                "--oiioattrib openexr:core 0 IN -o OUT.exr)",
                display_name(path), it.name()));
        auto &to = several && name.view.empty() ? shared : channels;
        to.push_back({it.name(), channel_of(name.plain, it.channel())});
    }
    const std::size_t own = channels.size();
    const auto is_own = [&](const FileChannel &c) {
        return std::any_of(channels.begin(), channels.begin() + std::ptrdiff_t(own),
                           [&](const FileChannel &o) { return o.channel.name == c.channel.name; });
    };
    for (const FileChannel &channel : shared)
        if (!is_own(channel)) channels.push_back(channel);
    std::stable_sort(channels.begin(), channels.end(), [](const FileChannel &p, const FileChannel &q) {
        return p.channel.name < q.channel.name;
    });
    // If two channels get the same name (left.diffuse.R and diffuse.left.R), the first is used.
    const auto same_name = [](const FileChannel &p, const FileChannel &q) {
        return p.channel.name == q.channel.name;
    };
    channels.erase(std::unique(channels.begin(), channels.end(), same_name), channels.end());
    find_kinds_by(header, channels);
    name_colours(channels);
    colours_first(channels);
    return channels;
}

void colours_first(std::vector<FileChannel> &channels) {
    std::ranges::stable_sort(channels, {}, [](const FileChannel &c) {
        static constexpr std::array first{"R", "G", "B", "A"};
        return std::ranges::find(first, c.channel.name) - first.begin();
    });
}

Imf::Header header_of_view(const Imf::Header &header, const std::string &view) {
    if (!Imf::hasMultiView(header) && views_of(header).size() < 2) return header;
    Imf::Header result = without_attribute(header, "multiView");
    if (!view.empty()) result.setView(view);
    return result;
}

namespace {

std::vector<int> all_parts(const Imf::MultiPartInputFile &file) {
    std::vector<int> parts(std::size_t(file.parts()));
    std::iota(parts.begin(), parts.end(), 0);
    return parts;
}

} // namespace

std::vector<std::string> stereo_views(const std::string &path) {
    return with_exr(path, [](const Imf::MultiPartInputFile &file, const InputStream &) {
        return all_views(file, all_parts(file));
    });
}

std::vector<std::string> picture_layers(const std::string &path, const std::string &stereo_view) {
    return with_exr(path, [&](const Imf::MultiPartInputFile &file, const InputStream &) {
        const PartsOfView of_view = parts_of_view(file, all_parts(file), stereo_view, path);
        std::vector<std::string> names;
        for (const PictureLayer &picture :
             pictures_in(full_channels(file, of_view.numbers, of_view.view, path)))
            names.push_back(picture.name);
        return names;
    });
}

} // namespace sparselens
