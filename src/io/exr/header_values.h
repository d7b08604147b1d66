// The attributes of an EXR header as numbers and texts, by names that do not depend on the program that wrote them.
#pragma once

#include <ImfHeader.h>

#include <string>
#include <vector>

namespace sparselens {

struct HeaderValue {
    std::string name; // as the file spells it
    // In lower case, without the prefixes "exr/", "nuke/", "input/" and "openexr:" of Nuke and OpenImageIO.
    std::string key;
    // The elements of a number, vector, box (min, max) or matrix (row by row). For a text that consists of numbers
    // ("1,0,0", "{1 0 0}"), these numbers; otherwise empty.
    std::vector<double> numbers;
    std::string text;
};

std::vector<HeaderValue> header_values(const Imf::Header &header);

// The first value whose key is `name`, in any case, or null. A * in `name` stands for one part between slashes.
const HeaderValue *find_value(const std::vector<HeaderValue> &values, const std::string &name);

} // namespace sparselens
