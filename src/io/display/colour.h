// Colour spaces, by OpenColorIO: its configuration says which there are, which space a file is in (file rules), what
// scene-linear is (the role of that name) and how a display shows it.
//
// Errors (Error) name the configuration, and the colour space, display or view that it does not have.
#pragma once

#include "../../base/image.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace sparselens {

// From one colour space to another. Immutable; any number of threads may use it.
class ColourTransform {
public:
    // Of premultiplied colours: divided by their coverage, transformed, multiplied again; without coverage (a null
    // `a`, or 0) as they are.
    void apply(std::span<float> r, std::span<float> g, std::span<float> b, const float *a) const;
    bool changes_nothing() const;

private:
    friend class ColourConfig;
    struct Processor;
    std::shared_ptr<const Processor> processor_;
};

class ColourConfig {
public:
    // The file, else the one that $OCIO names, else share/ocio/config.ocio.
    explicit ColourConfig(const std::string &file = {});

    std::string scene_linear() const;                         // the space that all work is done in
    std::string space_of_file(const std::string &path) const; // by the file rules
    ColourTransform between(const std::string &from, const std::string &to) const;
    // From scene-linear; empty names: the configuration's default display, that display's default view.
    ColourTransform to_display(const std::string &display, const std::string &view) const;

private:
    struct Impl;
    std::shared_ptr<const Impl> impl_;
};

// Transforms whatever is a colour among the channels: R, G and B together, of no layer or of one (X.R, X.G, X.B).
// Coverage is A of the picture. Alpha, ids, depth and all else stay as they are. planes[k] are the values of
// channels[k], all of one size.
void transform_colours(const ColourTransform &transform, std::span<const Channel> channels,
                       std::span<const std::span<float>> planes);

void transform_colours(const ColourTransform &transform, Image &image);

} // namespace sparselens
