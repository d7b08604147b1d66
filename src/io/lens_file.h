// A lens's looks under a name, from a JSON file: {"name": "Petzval", "cat-eye": 1, "spherical": {"1.4": 0.6, "4": 0}}.
//
// Keys are the names of the options without dashes; "tilt" is [X, Y], "cat-eye-darkening" true or false, and "aperture" is
// a file beside this one. A number may depend on the f-number: between two of them it is linear in the number of stops,
// beyond the first and the last it stays.
#pragma once

#include "../view/look_values.h"

#include <optional>
#include <string>

namespace sparselens {

struct LensFile {
    std::string name; // of the lens; empty: none
    LookValues values;
};

// Throws Error, naming the file and the key, where it cannot be read or understood, and UsageError where a value depends on
// the f-number, which is unknown.
LensFile read_lens_file(const std::string &path, std::optional<double> fstop);

// What a user says of the looks: values, and files that hold more.
struct GivenLooks {
    LookValues values;
    std::string lens_file;     // what it says counts where `values` say nothing; empty: none
    std::string aperture_file; // the picture of the aperture; empty: none
};

// Reads the files, and puts `values` and the picture over what the lens file says, whose name is kept. Throws as
// read_lens_file() and read_aperture_picture().
LensFile read_looks(const GivenLooks &given, std::optional<double> fstop);

} // namespace sparselens
