// Options that tools which write pictures share.
#pragma once

#include "base/image.h"
#include "dof/methods.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace sparselens {

// "X,Y" as two finite numbers, or nothing.
std::optional<Imath::V2d> parse_pair(const std::string &text);

// The X,Y of --view: scene units, x right, y up. UsageError where it is none.
Imath::V2d view_offset(const std::string &text);

// `name` X,Y: a pixel in EXR coordinates, y down.
void add_pixel_option(CLI::App &app, const std::string &name, std::optional<Imath::V2i> &pixel,
                      const std::string &help);

// --method, by the table of methods.
void add_method_option(CLI::App &app, const GatherMethod *&method);

// -d half|float: the type colours are written in.
void add_type_option(CLI::App &app, bool &as_float);
Image in_type(Image image, bool as_float); // half channels become float where asked

} // namespace sparselens
