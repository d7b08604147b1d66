#include "base/error.h"
#include "base/text.h"
#include "io/files/file_stream.h"
#include "io/files/text_file.h"
#include "io/usd/usd_layer.h"
#include "io/usd/usd_tokens.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

namespace sparselens {

namespace {

using Kind = UsdToken::Kind;

constexpr int most_levels = 64;
constexpr std::size_t most_prims = 10'000, most_samples = 1'000'000, most_numbers = 16;
constexpr std::array composing{"references", "payload",   "inherits",    "specializes",
                               "variants",   "subLayers", "variantSets", "clips"};
constexpr std::array kept_types{"Camera", "RenderSettings"};
constexpr std::array kept_attributes{"focalLength",
                                     "horizontalAperture",
                                     "verticalAperture",
                                     "horizontalApertureOffset",
                                     "focusDistance",
                                     "verticalApertureOffset",
                                     "fStop",
                                     "projection",
                                     "clippingRange",
                                     "resolution",
                                     "pixelAspectRatio",
                                     "aspectRatioConformPolicy"};
constexpr std::array list_edits{"prepend", "append", "add", "delete", "reorder"};

bool is_kept(std::string_view name) {
    return is_among(kept_attributes, name) || name.starts_with("xformOp") || name.starts_with("sparselens:");
}

class Parser {
public:
    Parser(std::string_view text, const std::string &file) : tokens_(text, file) { layer_.file = file; }

    UsdLayer read() {
        if (tokens_.peek().is('(')) read_layer_metadata();
        while (tokens_.peek().kind != Kind::end) read_statement(layer_.root);
        return std::move(layer_);
    }

private:
    // How deep the brackets and prims around the next token are nested.
    class Level {
    public:
        explicit Level(Parser &parser) : parser_(parser) {
            if (++parser_.levels_ > most_levels)
                parser_.tokens_.refuse(fmt::format("nested deeper than {} levels", most_levels));
        }
        ~Level() { --parser_.levels_; }
        Level(const Level &) = delete;
        Level &operator=(const Level &) = delete;

    private:
        Parser &parser_;
    };

    void read_layer_metadata();
    template <typename Use>
    void read_metadata(const Use &use);
    void read_statement(UsdPrim &parent);
    void read_prim(UsdPrim &parent);
    void read_variants(UsdPrim &prim);
    void read_property(UsdPrim &prim);
    void read_samples(UsdAttribute &attribute);
    UsdValue read_value();
    void read_into(UsdValue &value);
    void skip_brackets();
    void skip_metadata() {
        if (tokens_.peek().is('(')) skip_brackets();
    }
    void note(std::string_view key, UsdPrim &prim) {
        if (!is_among(composing, key)) return;
        for (std::string *composed : {&prim.composed, &layer_.composed})
            if (composed->empty()) *composed = key;
    }

    UsdTokens tokens_;
    UsdLayer layer_;
    int levels_ = 0;
    std::size_t prims_ = 0, samples_ = 0;
};

// ( "comment" key = value  prepend key = value ... ): calls use(key, value).
template <typename Use>
void Parser::read_metadata(const Use &use) {
    const Level level(*this);
    tokens_.expect('(');
    while (!tokens_.take_if(')')) {
        if (tokens_.peek().kind == Kind::string || tokens_.peek().is(';')) {
            tokens_.take();
            continue;
        }
        std::string_view key = tokens_.expect(Kind::name, "the name of a piece of metadata");
        if (is_among(list_edits, key) && tokens_.peek().kind == Kind::name) key = tokens_.take().text;
        tokens_.expect('=');
        use(key, read_value());
    }
}

void Parser::read_layer_metadata() {
    read_metadata([&](std::string_view key, const UsdValue &value) {
        const auto positive = [&](double &to) {
            to = value.numbers.size() == 1 ? value.numbers[0] : 0;
            if (!(to > 1e-9 && to < 1e9)) tokens_.refuse(fmt::format("{} must be above 0", key));
        };
        if (key == "metersPerUnit") positive(layer_.metres_per_unit);
        if (key == "timeCodesPerSecond") positive(layer_.frames_per_second);
        if (key == "upAxis") {
            if (value.texts.size() != 1 || (value.texts[0] != "Y" && value.texts[0] != "Z"))
                tokens_.refuse("upAxis must be \"Y\" or \"Z\"");
            layer_.up_axis = value.texts[0][0];
        }
        if (key == "renderSettingsPrimPath" && value.texts.size() == 1)
            layer_.render_settings = value.texts[0];
        note(key, layer_.root);
    });
}

// A prim, a property, or a statement about the order of either.
void Parser::read_statement(UsdPrim &parent) {
    const UsdToken &next = tokens_.peek();
    if (tokens_.take_if(';')) return;
    if (next.is_name("def") || next.is_name("over") || next.is_name("class")) return read_prim(parent);
    if (&parent == &layer_.root && !next.is_name("reorder")) tokens_.refuse("expected def, over or class");
    if (next.is_name("variantSet")) return read_variants(parent);
    read_property(parent);
}

void Parser::read_prim(UsdPrim &parent) {
    const Level level(*this);
    UsdPrim prim;
    prim.defined = tokens_.take().text == "def";
    if (tokens_.peek().kind == Kind::name) prim.type = tokens_.take().text;
    prim.name = tokens_.expect(Kind::string, "the name of a prim in quotes");
    if (tokens_.peek().is('('))
        read_metadata([&](std::string_view key, const UsdValue &value) {
            if (key == "active")
                prim.active = !(value.texts == std::vector<std::string>{"false"} ||
                                value.numbers == std::vector<double>{0});
            note(key, prim);
        });
    tokens_.expect('{');
    while (!tokens_.take_if('}')) read_statement(prim);
    if (prim.children.empty() && !is_among(kept_types, prim.type)) return;
    if (++prims_ > most_prims) tokens_.refuse(fmt::format("more than {} cameras and settings", most_prims));
    for (const UsdPrim &other : parent.children)
        if (other.name == prim.name)
            tokens_.refuse(fmt::format("two prims of one parent are called '{}'", prim.name));
    parent.children.push_back(std::move(prim));
}

// variantSet "name" = { "a" (metadata) { ... } ... }: which of them counts is not known here.
void Parser::read_variants(UsdPrim &prim) {
    note("variantSets", prim);
    tokens_.take();
    tokens_.expect(Kind::string, "the name of a variant set in quotes");
    tokens_.expect('=');
    if (!tokens_.peek().is('{')) tokens_.refuse("expected '{'");
    skip_brackets();
}

// [custom] [uniform] type[] name [.timeSamples | .connect | .spline] [= value] [(metadata)]
void Parser::read_property(UsdPrim &prim) {
    std::string_view word = tokens_.expect(Kind::name, "a property");
    bool is_relationship = false;
    // The words before the name: what kind of property it is. The name is the last of them.
    while (!tokens_.peek().begins_line && (tokens_.peek().kind == Kind::name || tokens_.peek().is('['))) {
        is_relationship = is_relationship || word == "rel";
        if (tokens_.take_if('['))
            tokens_.expect(']');
        else
            word = tokens_.take().text;
    }
    const std::size_t dot = word.find('.');
    const std::string_view name = word.substr(0, dot),
                           part = dot == std::string_view::npos ? "" : word.substr(dot + 1);
    const bool kept = is_kept(name) && !is_relationship;
    UsdAttribute ignored;
    UsdAttribute &attribute = kept ? prim.attributes[std::string(name)] : ignored;
    if (tokens_.take_if('=')) {
        if (part == "timeSamples")
            read_samples(attribute);
        else if (part == "spline" || part == "connect")
            attribute.source = part;
        if (part == "spline")
            skip_brackets();
        else if (part == "connect")
            read_value();
        else if (part.empty() || part == "default")
            attribute.value = read_value();
        else if (part != "timeSamples")
            tokens_.refuse(fmt::format("'{}' is not understood", word));
    }
    skip_metadata();
}

// { time: value, ... }
void Parser::read_samples(UsdAttribute &attribute) {
    tokens_.expect('{');
    while (!tokens_.take_if('}')) {
        const double time = tokens_.peek().number;
        tokens_.expect(Kind::number, "a time");
        tokens_.expect(':');
        if (!(std::abs(time) <= 1e9)) tokens_.refuse("a time is out of range");
        attribute.samples[time] = read_value();
        if (++samples_ > most_samples) tokens_.refuse(fmt::format("more than {} time samples", most_samples));
        if (!tokens_.take_if(',') && !tokens_.peek().is('}')) tokens_.refuse("expected ',' or '}'");
    }
}

UsdValue Parser::read_value() {
    UsdValue value;
    read_into(value);
    skip_metadata(); // layer offset of a reference, or metadata of the property
    return value;
}

// Keeps the first numbers and texts. More of them belong to values that no camera has.
void Parser::read_into(UsdValue &value) {
    const auto keep = [&](auto &to, auto &&item) {
        if (to.size() <= most_numbers) to.emplace_back(std::forward<decltype(item)>(item));
    };
    if (tokens_.peek().is('{')) return skip_brackets();
    if (tokens_.peek().is('[') || tokens_.peek().is('(')) {
        const Level level(*this);
        const char end = tokens_.take().is('[') ? ']' : ')';
        while (!tokens_.take_if(end)) {
            read_into(value);
            skip_metadata(); // the layer offset of a reference
            if (!tokens_.take_if(',') && !tokens_.peek().is(end))
                tokens_.refuse(fmt::format("expected ',' or '{}'", end));
        }
        return;
    }
    const UsdToken token = tokens_.take();
    if (token.kind == Kind::number) return keep(value.numbers, token.number);
    if (token.is_name("inf")) return keep(value.numbers, HUGE_VAL);
    if (token.is_name("nan")) return keep(value.numbers, std::nan(""));
    if (token.kind == Kind::mark || token.kind == Kind::end) tokens_.refuse("expected a value");
    if (token.kind == Kind::asset && tokens_.peek().kind == Kind::path) tokens_.take(); // @file@</prim>
    keep(value.texts, token.text);
}

// Passes over brackets of any kind and all that they hold.
void Parser::skip_brackets() {
    const Level level(*this);
    const UsdToken open = tokens_.take();
    const char end = open.is('(') ? ')' : open.is('[') ? ']' : '}';
    if (!open.is('(') && !open.is('[') && !open.is('{')) tokens_.refuse("expected '{'");
    while (!tokens_.take_if(end)) {
        const UsdToken &next = tokens_.peek();
        if (next.is('(') || next.is('[') || next.is('{'))
            skip_brackets();
        else if (next.kind == Kind::end || next.is(')') || next.is(']') || next.is('}'))
            tokens_.refuse(fmt::format("expected '{}'", end));
        else
            tokens_.take();
    }
}

} // namespace

UsdLayer read_usd(const std::string &path) {
    const std::string text = read_text_file(path), name = display_name(path);
    if (text.starts_with("PXR-USDC") || text.starts_with("PK\3\4"))
        throw Error(name + ": is binary USD; convert it to text: usdcat --flatten IN -o OUT.usda");
    if (!text.starts_with("#usda ")) throw Error(name + ": is not textual USD, which begins with #usda 1.0");
    return Parser(text, name).read();
}

} // namespace sparselens
