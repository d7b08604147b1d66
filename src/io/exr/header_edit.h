// Changes to EXR headers. In OpenEXR 3.1 what Header::erase() takes out is leaked, and Header::insert() throws where
// there is an attribute of that name and another type.
#pragma once

#include <ImfAttribute.h>
#include <ImfHeader.h>

#include <string>

namespace sparselens {

// The header but for the attribute of that name, which is none that every header has.
Imf::Header without_attribute(const Imf::Header &header, const std::string &name);

// Puts the attribute in the place of any of that name, whatever the type of that was.
void set_attribute(Imf::Header &header, const std::string &name, const Imf::Attribute &attribute);

} // namespace sparselens
