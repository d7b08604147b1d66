// The keywords of the looks of a lens, which are named as the options: blades, cat_eye, tilt, ...
#pragma once

#include "io/lens_file.h"
#include "python/keywords.h"

#include <string>

namespace sparselens::python {

struct AskedLooks {
    GivenLooks given;
    std::string first; // the first of the keywords that is given; empty: none is
};

AskedLooks look_keywords(Keywords &keywords);

} // namespace sparselens::python
