// The attributes of an EXR header as numbers and texts, by names that do not depend on the program that wrote them; and
// changes to them.
#pragma once

#include <ImfAttribute.h>
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

// The header without the attribute of that name, which must not be one that every header has. In OpenEXR 3.1
// Header::erase() leaks what it removes.
Imf::Header without_attribute(const Imf::Header &header, const std::string &name);

// Sets the attribute, replacing any attribute of that name, whatever its type, at which Header::insert() throws.
void set_attribute(Imf::Header &header, const std::string &name, const Imf::Attribute &attribute);

} // namespace sparselens
