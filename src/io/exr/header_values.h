// The attributes of an EXR header as numbers and texts, by names that do not depend on who wrote them.
#pragma once

#include <ImfHeader.h>

#include <string>
#include <vector>

namespace sparselens {

struct HeaderValue {
    std::string name; // as the file spells it
    // Lower case, without the "exr/", "nuke/", "input/", "openexr:" that Nuke and OpenImageIO put before names.
    std::string key;
    // Of numbers, vectors, boxes (min, max) and matrices (row by row); of a text, those it consists of ("1,0,0",
    // "{1 0 0}"), else none.
    std::vector<double> numbers;
    std::string text;
};

std::vector<HeaderValue> header_values(const Imf::Header &header);

// The first whose key is `name`, whatever its case; a * in it stands for one part between slashes. Null: none.
const HeaderValue *find_value(const std::vector<HeaderValue> &values, const std::string &name);

} // namespace sparselens
