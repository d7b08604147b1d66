#include "io/exr/exr_header.h"

#include "base/error.h"
#include "base/text.h"

#include <ImfBoxAttribute.h>
#include <ImfCompression.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>
#include <OpenEXRConfig.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

namespace sparselens {

namespace {

using Numbers = std::vector<double>;

std::string without_prefixes(std::string key) {
    for (bool found = true; found;) {
        found = false;
        for (const std::string_view prefix : {"exr/", "nuke/", "input/", "openexr:"})
            if (key.starts_with(prefix)) key.erase(0, prefix.size()), found = true;
    }
    return key;
}

bool matches(std::string_view key, const std::string &pattern) {
    const std::size_t star = pattern.find('*');
    if (star == std::string::npos) return key == pattern;
    const std::string_view before(pattern.data(), star), after = std::string_view(pattern).substr(star + 1);
    if (key.size() < before.size() + after.size() || !key.starts_with(before) || !key.ends_with(after))
        return false;
    key.remove_prefix(before.size());
    key.remove_suffix(after.size());
    return !key.empty() && key.find('/') == key.npos;
}

// The decimal number from which a float was made: 0.3f means 0.3, so that metadata and options give the same lens.
double decimal(float stored) {
    if (!std::isfinite(stored)) return double(stored);
    char text[32];
    const auto written =
        std::to_chars(text, text + sizeof text, stored); // the shortest text that reads back as `stored`
    double value = 0;
    std::from_chars(text, written.ptr, value);
    return value;
}

Numbers numbers_in_text(const std::string &text) {
    constexpr std::string_view separators = " ,;()[]{}\t\n";
    Numbers numbers;
    const char *at = text.data(), *const end = at + text.size();
    while (at != end) {
        if (separators.find(*at) != separators.npos || (*at == '+' && at + 1 != end)) {
            ++at;
            continue;
        }
        double value = 0;
        const auto [after, error] = std::from_chars(at, end, value);
        if (error != std::errc() || numbers.size() == 16) return {};
        numbers.push_back(value);
        at = after;
    }
    return numbers;
}

template <typename Type>
const Type *value_of(const Imf::Attribute &attribute) {
    const auto *typed = dynamic_cast<const Imf::TypedAttribute<Type> *>(&attribute);
    return typed ? &typed->value() : nullptr;
}

template <typename Matrix>
Numbers elements(const Matrix &m) {
    Numbers all;
    for (int i = 0; i < 16; ++i) all.push_back(double(m[i / 4][i % 4]));
    return all;
}

Numbers numbers_in(const Imf::Attribute &a) {
    if (const auto *v = value_of<float>(a)) return {decimal(*v)};
    if (const auto *v = value_of<double>(a)) return {*v};
    if (const auto *v = value_of<int>(a)) return {double(*v)};
    if (const auto *v = value_of<std::string>(a)) return numbers_in_text(*v);
    if (const auto *v = value_of<Imath::V2f>(a)) return {decimal(v->x), decimal(v->y)};
    if (const auto *v = value_of<Imath::V2d>(a)) return {v->x, v->y};
    if (const auto *v = value_of<Imath::M44f>(a)) return elements(*v);
    if (const auto *v = value_of<Imath::M44d>(a)) return elements(*v);
    if (const auto *v = value_of<Imath::Box2i>(a))
        return {double(v->min.x), double(v->min.y), double(v->max.x), double(v->max.y)};
    return {};
}

} // namespace

std::vector<HeaderValue> header_values(const Imf::Header &header) {
    std::vector<HeaderValue> values;
    for (auto it = header.begin(); it != header.end(); ++it) {
        const auto *text = value_of<std::string>(it.attribute());
        values.push_back({it.name(), without_prefixes(lower_case(it.name())), numbers_in(it.attribute()),
                          text ? *text : std::string()});
    }
    return values;
}

const HeaderValue *find_value(const std::vector<HeaderValue> &values, const std::string &name) {
    const std::string pattern = lower_case(name);
    const auto found =
        std::ranges::find_if(values, [&](const HeaderValue &value) { return matches(value.key, pattern); });
    return found == values.end() ? nullptr : &*found;
}

std::string text_attribute(const Imf::Header &header, const char *name) {
    const auto *text = header.findTypedAttribute<Imf::StringAttribute>(name);
    return text ? text->value() : std::string();
}

Imf::Header without_attribute(const Imf::Header &header, const std::string &name) {
    Imf::Header result;
    for (auto i = header.begin(); i != header.end(); ++i)
        if (i.name() != name) result.insert(i.name(), i.attribute());
    return result;
}

void set_attribute(Imf::Header &header, const std::string &name, const Imf::Attribute &attribute) {
    const auto old = header.find(name);
    if (old != header.end() && std::string_view(old.attribute().typeName()) != attribute.typeName())
        header = without_attribute(header, name);
    header.insert(name, attribute);
}

namespace {

constexpr std::uint32_t magic = 20000630, several_parts = 0x1000;
constexpr std::size_t longest_name = 255;

struct FixedSize {
    std::string_view type;
    std::uint64_t bytes;
};
constexpr std::array<FixedSize, 24> fixed_sizes{{{"box2f", 16},
                                                 {"box2i", 16},
                                                 {"chromaticities", 32},
                                                 {"compression", 1},
                                                 {"deepImageState", 1},
                                                 {"double", 8},
                                                 {"envmap", 1},
                                                 {"float", 4},
                                                 {"int", 4},
                                                 {"keycode", 28},
                                                 {"lineOrder", 1},
                                                 {"m33d", 72},
                                                 {"m33f", 36},
                                                 {"m44d", 128},
                                                 {"m44f", 64},
                                                 {"rational", 8},
                                                 {"tiledesc", 9},
                                                 {"timecode", 8},
                                                 {"v2d", 16},
                                                 {"v2f", 8},
                                                 {"v2i", 8},
                                                 {"v3d", 24},
                                                 {"v3f", 12},
                                                 {"v3i", 12}}};

// The name of a method, and the OpenEXR that brought it.
std::string newer_method(int code) {
    static constexpr std::array names{"HTJ2K256, 3.4", "HTJ2K32, 3.4", "LJ2K, 3.5", "ZSTD, 3.5"};
    const std::size_t index = std::size_t(code) - std::size_t(Imf::DWAB_COMPRESSION) - 1;
    return index < names.size() ? names[index] : fmt::format("code {}", code);
}

class HeaderWalk {
public:
    HeaderWalk(InputStream &in, const std::string &path) : in_(in), path_(path) {}

    void run() {
        if (in_.bytes() < 8) return;
        if (word() != magic) fail_as_other();
        const bool multipart = (word() & several_parts) != 0;
        bool more = one_header();
        while (more && multipart) more = one_header();
    }

private:
    // Returns false if the header is empty.
    bool one_header() {
        for (bool empty = true;; empty = false) {
            const std::string name = text();
            if (name.empty()) return !empty;
            const std::string type = text();
            check_attribute(name, type, word());
        }
    }

    void check_attribute(const std::string &name, const std::string &type, std::uint64_t bytes) {
        const std::uint64_t begin = in_.tellg();
        if (bytes > in_.bytes() - begin)
            fail(name, fmt::format("claims {} bytes, more than the file has", bytes));
        for (const FixedSize &fixed : fixed_sizes)
            if (fixed.type == type && fixed.bytes != bytes) fail(name, "does not have the size of its type");
        if (type == "chlist" && channels() != begin + bytes)
            fail(name, "does not have the size that it claims");
        if (type == "preview" && !is_preview(bytes)) fail(name, "does not have the size that it claims");
        if (type == "stringvector" && !is_list(begin + bytes))
            fail(name, "does not have the size that it claims");
        if (const int code = type == "compression" ? byte() : 0; code >= int(Imf::NUM_COMPRESSION_METHODS))
            throw Error(fmt::format("{}: compressed by a newer OpenEXR than " OPENEXR_VERSION_STRING
                                    " ({}): where that is, oiiotool IN --compression zips -o OUT.exr",
                                    display_name(path_), newer_method(code)));
        in_.seekg(begin + bytes);
    }

    // Returns where a list of channels ends. It holds names with 16 bytes each, then an empty name.
    std::uint64_t channels() {
        while (!text().empty()) skip(16);
        return in_.tellg();
    }
    bool is_preview(std::uint64_t bytes) {
        if (bytes < 8) return false;
        const std::uint64_t width = word(), height = word();
        return width * height == (bytes - 8) / 4 && bytes % 4 == 0;
    }
    bool is_list(std::uint64_t end) {
        while (in_.tellg() + 4 <= end) {
            const std::uint64_t bytes = word();
            if (bytes > end - in_.tellg()) return false;
            skip(bytes);
        }
        return in_.tellg() == end;
    }

    [[noreturn]] void fail_as_other() {
        std::array<char, 16> bytes{};
        in_.seekg(0);
        in_.read(bytes.data(), int(std::min<std::uint64_t>(bytes.size(), in_.bytes())));
        throw Error(display_name(path_) + ": " + not_exr({bytes.data(), bytes.size()}));
    }
    [[noreturn]] void fail(const std::string &name, const std::string &what) const {
        throw Error(fmt::format("{}: attribute {} {}", display_name(path_), name, what));
    }
    void skip(std::uint64_t bytes) {
        const std::uint64_t at = in_.tellg();
        if (bytes > in_.bytes() - at) throw Error(display_name(path_) + ": the file is truncated");
        in_.seekg(at + bytes);
    }
    unsigned char byte() {
        char c;
        in_.read(&c, 1);
        return static_cast<unsigned char>(c);
    }
    std::uint32_t word() { // little-endian
        std::uint32_t value = 0;
        for (int shift = 0; shift < 32; shift += 8) value |= std::uint32_t(byte()) << shift;
        return value;
    }
    std::string text() {
        std::string name;
        for (unsigned char c = byte(); c != 0; c = byte()) {
            name += char(c);
            if (name.size() > longest_name)
                throw Error(display_name(path_) + ": a name in the header does not end");
        }
        return name;
    }

    InputStream &in_;
    const std::string &path_;
};

} // namespace

void check_header(InputStream &in, const std::string &path) {
    HeaderWalk(in, path).run();
    in.seekg(0);
}

namespace {

constexpr const char *own_name = "sparselens:samples";

} // namespace

std::optional<double> render_samples(const Imf::Header &header) {
    if (const auto *own = header.findTypedAttribute<Imf::IntAttribute>(own_name); own && own->value() > 0)
        return own->value();
    std::optional<double> most;
    for (auto at = header.begin(); at != header.end(); ++at) {
        const std::string_view name = at.name();
        const auto *text = dynamic_cast<const Imf::StringAttribute *>(&at.attribute());
        if (!text || !name.starts_with("cycles.") || !name.ends_with(".samples")) continue;
        if (const auto count = number_of<double>(text->value()); count > 0.0)
            most = std::max(most.value_or(0), *count);
    }
    return most;
}

void write_render_samples(Imf::Header &header, int samples) {
    header.insert(own_name, Imf::IntAttribute(samples));
}

} // namespace sparselens
