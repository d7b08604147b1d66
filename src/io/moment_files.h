// Files of the moments of one shutter. %s in a name stands for the number of a moment: shot.0001_%s.exr are
// shot.0001_0.exr, shot.0001_1.exr, ...
#pragma once

#include "shutter/shutter_mean.h"

#include <ImfHeader.h>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens {

inline constexpr const char *moment_placeholder = "%s";

// The length of the folders at the beginning of a path that exist. What a tool would replace in a name (%s, ####, %V) is
// a part of their names.
std::size_t existing_folders(const std::string &path);

// The path with the text in the place of each placeholder behind the folders that exist.
std::string with_placeholder(std::string path, std::string_view placeholder, const std::string &text);

// Whether the name has %s behind the folders that exist, and is not the name of an existing file.
bool names_moments(const std::string &path);

// The name with the number in the place of each %s.
std::string at_moment(std::string path, const std::string &number);

// The name of the picture of all moments: without each %s and the dot, line or dash before it.
std::string without_moment(std::string path);

// The numbers of the moments that exist, as the files spell them, ascending. Throws Error if there is none, or if one
// is missing in between.
std::vector<std::string> moments_on_disk(const std::string &path);

// The moment (from 0) that a picture shows, and the number of moments, if its header states them.
struct StatedMoment {
    int moment, moments;
};
std::optional<StatedMoment> stated_moment(const Imf::Header &header);
void write_stated_moment(Imf::Header &header, const StatedMoment &moment);
Imf::Header without_stated_moment(const Imf::Header &header);

// "box", "triangle" or "gaussian" ("" is a box), or the name of a file. Each line of a file is a time and a value, as
// in ShutterCurve; lines that begin with # and empty lines do not count. Throws Error, naming file and line, if the
// file cannot be read or understood.
ShutterCurve shutter_curve(const std::string &name);

} // namespace sparselens
