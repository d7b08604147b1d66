#include "io/own_depth.h"

#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

namespace sparselens {

namespace {

using Text = std::string_view;
using enum OwnDepth::Values;

[[noreturn]] void fail(const char *why) { throw std::runtime_error(why); }

// Namespaces of XMP.
constexpr Text rdf = "http://www.w3.org/1999/02/22-rdf-syntax-ns#", notes = "http://ns.adobe.com/xmp/note/",
               gdepth = "http://ns.google.com/photos/1.0/depthmap/",
               dynamic = "http://ns.google.com/photos/dd/1.0/depthmap/",
               dynamic_item = "http://ns.google.com/photos/dd/1.0/item/",
               container_item = "http://ns.google.com/photos/1.0/container/item/",
               apple = "http://ns.apple.com/pixeldatainfo/1.0/";

// How XMP spells a name of the namespace: with the prefix that it gives to it; empty if it gives none.
std::string spelled_in(Text xmp, Text space, Text name) {
    const std::size_t uri = xmp.find(space.substr(0, space.size() - 1)); // some leave out the slash
    const std::size_t prefix = uri == Text::npos ? uri : xmp.rfind("xmlns:", uri);
    if (prefix == Text::npos) return {};
    return fmt::format("{}:{}", trimmed(xmp.substr(prefix + 6, uri - prefix - 6), " \t\r\n='\""), name);
}

// The first value of a name, which is an attribute or an element with a text; empty if there is none.
Text value_in(Text xmp, const std::string &name) {
    for (std::size_t at = 0; !name.empty() && (at = xmp.find(name, at)) != Text::npos;) {
        const bool element = at > 0 && xmp[at - 1] == '<',
                   whole = at > 0 && Text("< \t\r\n").find(xmp[at - 1]) != Text::npos;
        at = xmp.find_first_not_of(" \t\r\n=", at + name.size());
        if (at == Text::npos) break;
        const char mark = xmp[at];
        if (!whole || (element ? mark != '>' : mark != '"' && mark != '\''))
            continue; // a longer name, or its end
        const std::size_t end = xmp.find(element ? '<' : mark, at + 1);
        if (end == Text::npos) fail("the XMP is damaged");
        return trimmed(xmp.substr(at + 1, end - at - 1));
    }
    return {};
}

struct Xmp {
    Text main;
    std::string more = {}; // extended XMP

    Text value(Text space, Text name) const {
        const Text value = value_in(main, spelled_in(main, space, name));
        return value.empty() ? value_in(more, spelled_in(more, space, name)) : value;
    }
    double number(Text space, Text name) const { return number_of<double>(value(space, name)).value_or(0); }
};

std::string from_base64(Text text) {
    constexpr Text values = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t last = 0; // 24 bits
    std::size_t digits = 0, fill = 0;
    for (const char c : text) {
        if (Text(" \t\r\n").find(c) != Text::npos) continue;
        const std::size_t value = values.find(c);
        if (c == '=' ? ++fill > 2 : value == Text::npos || fill > 0) fail("the base64 is damaged");
        if (c == '=') continue;
        last = last << 6 | std::uint32_t(value);
        if (++digits % 4 != 1) bytes += char(last >> (6 - 2 * ((digits + 3) % 4)));
    }
    if (digits % 4 == 1 || (fill > 0 && (digits + fill) % 4 != 0)) fail("the base64 is cut off");
    return bytes;
}

// A JPEG in a file.
struct Jpeg {
    std::size_t end = Text::npos; // behind its last byte; npos: it is cut off
    Text xmp = {};
    std::vector<Text> more = {}; // pieces of extended XMP
};

std::size_t number_at(Text bytes, std::size_t at, std::size_t size) {
    std::size_t number = 0;
    for (const char byte : bytes.substr(std::min(at, bytes.size()), size))
        number = number << 8 | std::uint8_t(byte);
    return number;
}

Jpeg jpeg_at(Text file, std::size_t at) {
    constexpr Text first("http://ns.adobe.com/xap/1.0/\0", 29),
        more("http://ns.adobe.com/xmp/extension/\0", 35);
    Jpeg jpeg;
    for (at += 2; (at = file.find('\xff', at)) < file.size() - 1;) {
        const auto marker = std::uint8_t(file[at + 1]);
        if (marker == 0xd9) {
            jpeg.end = at + 2;
            break;
        }
        if (marker <= 1 || (marker >= 0xd0 && marker <= 0xd7) ||
            marker == 0xff) { // in pixels, or before a marker
            ++at;
            continue;
        }
        const std::size_t size = std::max<std::size_t>(number_at(file, at + 2, 2), 2);
        const Text segment = file.substr(std::min(at + 4, file.size()), marker == 0xe1 ? size - 2 : 0);
        if (segment.starts_with(first)) jpeg.xmp = segment.substr(first.size());
        if (segment.starts_with(more)) jpeg.more.push_back(segment.substr(more.size()));
        at += 2 + size;
    }
    return jpeg;
}

// Each piece begins with the name of the whole, its size, and where the piece belongs.
std::string extended_xmp(const Jpeg &jpeg, Text name) {
    std::map<std::size_t, Text> pieces;
    std::size_t size = 0;
    for (const Text piece : jpeg.more)
        if (piece.size() > 40 && piece.substr(0, 32) == name) {
            size = number_at(piece, 32, 4);
            pieces[number_at(piece, 36, 4)] = piece.substr(40);
        }
    std::string all;
    for (const auto &[at, piece] : pieces)
        if (at == all.size()) all += piece;
    if (all.empty() || all.size() != size) fail("a part of the XMP is missing");
    return all;
}

OwnDepth described(std::string picture, const Xmp &xmp, Text space) {
    const Text format = xmp.value(space, "Format");
    if (format != "RangeInverse" && format != "RangeLinear")
        fail("the Format is neither RangeInverse nor RangeLinear");
    return {std::move(picture), format == "RangeLinear" ? linear : inverse, xmp.number(space, "Near"),
            xmp.number(space, "Far")};
}

// The depth in the directory, whose first item is the JPEG itself. The others follow it.
std::optional<std::string> depth_item(Text file, const Jpeg &jpeg) {
    const Text xmp = jpeg.xmp, uri = value_in(xmp, spelled_in(xmp, dynamic, "DepthURI"));
    const std::string li = fmt::format("<{}", spelled_in(xmp, rdf, "li"));
    std::string prefix = spelled_in(xmp, dynamic_item, "");
    if (prefix.empty()) prefix = spelled_in(xmp, container_item, "");
    std::size_t begin = 0; // of an item in the file; 0: the first one is still to come
    for (std::size_t at = prefix.empty() ? Text::npos : xmp.find(li), next = 0; at != Text::npos; at = next) {
        next = xmp.find(li, at + 1);
        const Text item = xmp.substr(at, next - at);
        if (item.find(prefix) == Text::npos) continue;
        const auto bytes = [&](const char *name) -> std::size_t {
            const Text said = value_in(item, prefix + name);
            return said.empty() ? 0 : number_of<std::uint32_t>(said).value_or(UINT32_MAX);
        };
        const Text semantic = value_in(item, prefix + "Semantic"),
                   item_uri = value_in(item, prefix + "DataURI");
        const std::size_t size = begin == 0 ? std::min(jpeg.end, file.size()) : bytes("Length");
        if (begin > 0 &&
            (semantic == "Depth" || semantic == "DepthMap" || (!uri.empty() && item_uri == uri))) {
            if (size == 0 || begin + size > file.size()) fail("it is not where the XMP says");
            return std::string(file.substr(begin, size));
        }
        begin += size + bytes("Padding");
    }
    return {};
}

std::optional<OwnDepth> depth_of_apple(Text file, std::size_t at) {
    while (at < file.size() && (at = file.find("\xff\xd8\xff", at)) != Text::npos) {
        const Jpeg jpeg = jpeg_at(file, at);
        const Xmp xmp{jpeg.xmp};
        const Text type = xmp.value(apple, "AuxiliaryImageType");
        if (type == "disparity" || type == "depth")
            return OwnDepth{std::string(file.substr(at, jpeg.end - at)), type == "depth" ? linear : disparity,
                            xmp.number(apple, "FloatMinValue"), xmp.number(apple, "FloatMaxValue")};
        at = jpeg.end;
    }
    return {};
}

std::optional<OwnDepth> found_depth(Text file) {
    const Jpeg jpeg = jpeg_at(file, 0);
    Xmp xmp{jpeg.xmp};
    if (const Text name = xmp.value(notes, "HasExtendedXMP"); !name.empty())
        xmp.more = extended_xmp(jpeg, name);
    if (const Text data = xmp.value(gdepth, "Data"); !data.empty())
        return described(from_base64(data), xmp, gdepth);
    if (auto item = depth_item(file, jpeg)) return described(std::move(*item), xmp, dynamic);
    for (const Text space : {gdepth, dynamic})
        if (!xmp.value(space, "Format").empty()) fail("the XMP describes it, but the file does not have it");
    return depth_of_apple(file, jpeg.end);
}

} // namespace

std::optional<OwnDepth> own_depth_of_jpeg(Text file) {
    auto depth = found_depth(file);
    if (!depth) return {};
    if (!depth->picture.starts_with("\xff\xd8") && !depth->picture.starts_with("\x89PNG"))
        fail("it is neither a PNG nor a JPEG");
    if (depth->values == linear &&
        !(depth->near > 0 && depth->far > depth->near && std::isfinite(depth->far)))
        fail("Near and Far are not depths");
    return depth;
}

void make_disparities(const OwnDepth &of, std::span<float> values) {
    if (of.values == disparity) return;
    for (float &v : values) {
        const double z = of.near + double(v) * (of.far - of.near);
        v = of.values == inverse ? 1 - v : float(of.near * (of.far - z) / (z * (of.far - of.near)));
    }
}

} // namespace sparselens
