#include "io/render_samples.h"

#include <ImfIntAttribute.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <charconv>
#include <string_view>

namespace sparselens {

namespace {

constexpr const char *own_name = "sparselens:samples";

// Parses a number such as "64".
std::optional<double> count_of(std::string_view text) {
    double count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (error != std::errc() || end != text.data() + text.size() || !(count > 0)) return {};
    return count;
}

} // namespace

std::optional<double> render_samples(const Imf::Header &header) {
    if (const auto *own = header.findTypedAttribute<Imf::IntAttribute>(own_name); own && own->value() > 0)
        return own->value();
    std::optional<double> most;
    for (auto at = header.begin(); at != header.end(); ++at) {
        const std::string_view name = at.name();
        const auto *text = dynamic_cast<const Imf::StringAttribute *>(&at.attribute());
        if (!text || !name.starts_with("cycles.") || !name.ends_with(".samples")) continue;
        if (const auto count = count_of(text->value())) most = std::max(most.value_or(0), *count);
    }
    return most;
}

void write_render_samples(Imf::Header &header, int samples) {
    header.insert(own_name, Imf::IntAttribute(samples));
}

} // namespace sparselens
