// Pictures that are made when they are read: the words of a dof-gather command line from a .dof file, a query and a
// frame.
//
// A .dof file is JSON: {"ldi": "shot.%04d.ldi.exr", "focus": {"1": 2.5, "24": 4}, "fstop": 1.4, "lens": "petzval"}. The
// other keys are options of dof-gather without dashes; "focus" is short for "focus-distance". A value is a number, a
// text, true or false for a flag, [X, Y], or keys by frame. Files are relative to the folder of the .dof file; "lens"
// may also be one of share/lenses.
#pragma once

#include "viewing/page_request.h"

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <optional>
#include <string>

namespace sparselens {

struct PictureSource {
    std::string file; // a .dof file, or an LDI
    std::map<std::string, std::string> settings =
        {};                        // option without dashes -> value, over those of the file
    std::string query = {};        // "focus=3.4&fstop=1.4": over both
    std::optional<int> frame = {}; // else "frame" of the query
};

// The settings in an object of JSON, as text. Throws UsageError, naming the key and `where`, if a value is of another
// kind.
std::map<std::string, std::string> settings_in(const nlohmann::json &object, const std::string &where);

// IN and the options of dof-gather for the frame: if none is given, the one whose number ends the name of the .dof
// file (shot.0012.dof), else the first of a sequence. Throws UsageError and Error, naming the file and the key.
Words words_of(const PictureSource &source, const Presets &presets);

// The files on which the picture of words_of() depends: IN, the values of options, each moment of a shutter, and the
// aperture of a lens file. Throws UsageError for a pipe or device among them.
std::vector<std::string> files_in(const Words &words);

} // namespace sparselens
