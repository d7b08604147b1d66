// The keywords of the looks of a lens, which are named as the options: blades, cat_eye, tilt, ...
#pragma once

#include "io/lens_file.h"
#include "python/keywords.h"

#include <optional>
#include <string>

namespace sparselens::python {

struct AskedLooks {
    LookValues values;
    std::string lens_file, aperture_file;
    std::string first; // the first of the keywords that is given; empty: none is
};

AskedLooks look_keywords(Keywords &keywords);

// What the keywords say over what the lens file says. The errors are those of the two files.
LensFile read_looks(const AskedLooks &asked, std::optional<double> fstop);

} // namespace sparselens::python
