// The looks of a lens under a name, from a JSON file: {"name": "Petzval", "cat-eye": 1, "spherical": {"1.4": 0.6, "4":
// 0}}.
//
// Keys are the names of the options without dashes; "tilt" is [X, Y], "cat-eye-darkening" is true or false, and
// "aperture" is a file beside this one. A number may depend on the f-number: between two f-numbers it is linear in
// stops, and beyond the first and the last it is constant.
#pragma once

#include "../lens/lens_looks.h"
#include "../looks/table.h"

#include <map>
#include <memory>
#include <optional>
#include <string>

namespace sparselens {

struct LensFile {
    std::string name; // of the lens; may be empty
    LookValues values;
};

// Throws UsageError if a value depends on the f-number and this is unknown.
LensFile read_lens_file(const std::string &path, std::optional<double> fstop);

// The file of the aperture that a lens file names; empty if it names none.
std::string aperture_named_in(const std::string &lens_file);

// The lens files of share/lenses, where the program was installed or built, by their names ("petzval").
std::map<std::string, std::string> installed_lenses();

// The looks that a user gives: values, and files with further values.
struct GivenLooks {
    LookValues values;
    std::string lens_file;     // or the name of an installed lens; provides what `values` lack; empty: none
    std::string aperture_file; // the picture of the aperture; empty: none
};

// Reads the files. `values` and the picture take precedence over the lens file, whose name is kept. Throws as
// read_lens_file() and read_aperture_picture() do.
LensFile read_looks(const GivenLooks &given, std::optional<double> fstop);

// Reads R, G and B; if they are missing, Y; otherwise the only channel besides A. Alpha is ignored. A picture of more
// than 2048 pixels a side is averaged down, because the gather needs up to 100 bytes for each of its pixels. Throws
// Error, naming the file, if it cannot be read, has no such channels, or has values that are negative, not finite, or
// all black.
std::shared_ptr<const AperturePicture> read_aperture_picture(const std::string &path);

} // namespace sparselens
