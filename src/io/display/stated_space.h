// The colour space that the header of an EXR states. In this order: chromaticities; colorInteropID, an id of the Color
// Interop Forum (OpenEXR 3.4, Blender 5, OpenImageIO 3.1); oiio:ColorSpace, which is such an id or a configuration's
// name.
#pragma once

#include "colour.h"

#include <ImfHeader.h>

#include <optional>
#include <string>

namespace sparselens {

// Whether the header states a space. The ids "unknown" and "data" do not.
bool states_space(const Imf::Header &header);

struct StatedSpace {
    std::string attribute;            // the attribute that states it
    std::optional<std::string> space; // the configuration's name for it, if it has one
};

// The stated space; empty if there is none, or only an oiio:ColorSpace that the configuration does not know.
std::optional<StatedSpace> stated_space(const ColourConfig &config, const Imf::Header &header);

// The header for colours in that space: with its chromaticities, or without if it has none. The other attributes stay
// if they agree; otherwise the id becomes that of the space or is removed, and oiio:ColorSpace is removed.
Imf::Header with_space(const ColourConfig &config, const Imf::Header &header, const std::string &space);

// The header, with the statements of `other` about the space of its colours.
Imf::Header with_space_of(const Imf::Header &other, const Imf::Header &header);

} // namespace sparselens
