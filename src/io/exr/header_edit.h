// Changes to EXR headers. In OpenEXR 3.1 Header::erase() leaks what it removes, and Header::insert() throws if an
// attribute of the same name has another type.
#pragma once

#include <ImfAttribute.h>
#include <ImfHeader.h>

#include <string>

namespace sparselens {

// The header without the attribute of that name, which must not be one that every header has.
Imf::Header without_attribute(const Imf::Header &header, const std::string &name);

// Sets the attribute, replacing any attribute of that name, whatever its type.
void set_attribute(Imf::Header &header, const std::string &name, const Imf::Attribute &attribute);

} // namespace sparselens
