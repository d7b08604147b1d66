// Colour spaces by OpenColorIO. Its configuration defines the spaces, the space of a file (by file rules), the space of
// the role scene_linear, and how a display shows it.
//
// Throws Error, naming the configuration, if it lacks a colour space, display or view.
#pragma once

#include "../../base/image.h"

#include <Imath/ImathMatrix.h>
#include <ImfChromaticities.h>
#include <ImfHeader.h>

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace sparselens {

// Curves of R, G and B, each with its values at equal steps from 0 to 1, and then a matrix (row vectors).
struct CurvesAndMatrix {
    std::array<std::vector<float>, 3> curves; // of one length, rising
    Imath::M33d matrix;
};

// From one colour space to another. Immutable; any number of threads may use it.
class ColourTransform {
public:
    static ColourTransform of(const CurvesAndMatrix &made, bool inverse);

    // Transforms premultiplied colours: divides them by their coverage, transforms them and multiplies them again.
    // Colours without coverage (`a` is null or 0) are transformed as they are.
    void apply(std::span<float> r, std::span<float> g, std::span<float> b, const float *a) const;
    bool changes_nothing() const;

private:
    friend class ColourConfig;
    struct Processor;
    std::shared_ptr<const Processor> processor_;
};

class ColourConfig {
public:
    // Reads the file; if it is empty, the one that $OCIO names; if that is unset, share/ocio/config.ocio.
    explicit ColourConfig(const std::string &file = {});
    static ColourConfig built_in(); // share/ocio/config.ocio

    std::string scene_linear() const;                         // the space in which all work is done
    std::string space_of_file(const std::string &path) const; // by the file rules
    ColourTransform between(const std::string &from, const std::string &to) const;
    // Empty names mean the default display and its default view, and scene_linear().
    ColourTransform to_display(const std::string &display, const std::string &view,
                               const std::string &from = {}) const;

    // linear_space() returns the linear space of these primaries and this white, if the configuration has it under one
    // of its usual names. chromaticities_of() returns the primaries and white of such a space, by any of its names.
    // Both return nothing for all other spaces.
    std::optional<std::string> linear_space(const Imf::Chromaticities &chromaticities) const;
    std::optional<Imf::Chromaticities> chromaticities_of(const std::string &space) const;

    // space_named() returns the configuration's own name of a space, by any of its names there or by its id of the
    // Color Interop Forum (lin_ap1_scene). interop_id() returns the id of a space; it is empty for spaces that are
    // neither linear ones as above nor have an id in the configuration (OpenColorIO 2.5).
    std::optional<std::string> space_named(const std::string &name_or_id) const;
    std::string interop_id(const std::string &space) const;

private:
    struct Impl;
    explicit ColourConfig(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
    std::shared_ptr<const Impl> impl_;
};

// Transforms the colours among the channels: R, G and B together, with or without a layer (X.R, X.G, X.B). The coverage
// is A of the picture. Alpha, ids, depth and all other channels stay as they are. planes[k] holds the values of
// channels[k]; all planes have the same size.
void transform_colours(const ColourTransform &transform, std::span<const Channel> channels,
                       std::span<const std::span<float>> planes);

void transform_colours(const ColourTransform &transform, Image &image);

// Whether these are the primaries and white of one space: programs round them in headers, to three places or more.
bool same_chromaticities(const Imf::Chromaticities &a, const Imf::Chromaticities &b);

// The colour space that the header of an EXR states. In this order: chromaticities; colorInteropID, an id of the Color
// Interop Forum (OpenEXR 3.4, Blender 5, OpenImageIO 3.1); oiio:ColorSpace, which is such an id or a configuration's
// name.

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
