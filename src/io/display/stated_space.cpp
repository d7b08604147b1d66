#include "io/display/stated_space.h"

#include "io/exr/header_values.h"

#include <ImfChromaticitiesAttribute.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include <array>

namespace sparselens {

namespace {

constexpr const char *interop_id = "colorInteropID", *oiio_space = "oiio:ColorSpace";

std::string text_of(const Imf::Header &header, const char *name) {
    const auto *attribute = header.findTypedAttribute<Imf::StringAttribute>(name);
    const std::string text = attribute ? attribute->value() : "";
    return text == "unknown" || text == "data" ? "" : text;
}

} // namespace

bool states_space(const Imf::Header &header) {
    return Imf::hasChromaticities(header) || !text_of(header, interop_id).empty() ||
           !text_of(header, oiio_space).empty();
}

std::optional<StatedSpace> stated_space(const ColourConfig &config, const Imf::Header &header) {
    if (Imf::hasChromaticities(header))
        return StatedSpace{"chromaticities", config.linear_space(Imf::chromaticities(header))};
    if (const std::string id = text_of(header, interop_id); !id.empty())
        return StatedSpace{interop_id, config.space_named(id)};
    if (const auto space = config.space_named(text_of(header, oiio_space)))
        return StatedSpace{oiio_space, space};
    return {};
}

Imf::Header with_space(const ColourConfig &config, const Imf::Header &header, const std::string &space) {
    Imf::Header result = header;
    if (const auto chromaticities = config.chromaticities_of(space))
        set_attribute(result, "chromaticities", Imf::ChromaticitiesAttribute(*chromaticities));
    else
        result = without_attribute(header, "chromaticities");
    for (const char *name : {interop_id, oiio_space}) {
        const bool is_there = header.find(name) != header.end();
        if (!is_there || config.space_named(text_of(header, name)) == config.space_named(space)) continue;
        const std::string id = name == interop_id ? config.interop_id(space) : "";
        if (id.empty())
            result = without_attribute(result, name);
        else
            set_attribute(result, name, Imf::StringAttribute(id));
    }
    return result;
}

Imf::Header with_space_of(const Imf::Header &other, const Imf::Header &header) {
    Imf::Header result = header;
    for (const char *name : {"chromaticities", interop_id, oiio_space}) {
        const auto said = other.find(name);
        if (said != other.end())
            set_attribute(result, name, said.attribute());
        else if (header.find(name) != header.end())
            result = without_attribute(result, name);
    }
    return result;
}

} // namespace sparselens
