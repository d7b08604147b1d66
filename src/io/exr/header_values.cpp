#include "io/exr/header_values.h"

#include "base/text.h"

#include <ImfBoxAttribute.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>

#include <algorithm>
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

} // namespace sparselens
