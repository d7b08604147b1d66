#include "io/exr/header_edit.h"

#include <string_view>

namespace sparselens {

Imf::Header without_attribute(const Imf::Header &header, const std::string &name) {
    Imf::Header result;
    for (auto i = header.begin(); i != header.end(); ++i)
        if (i.name() != name) result.insert(i.name(), i.attribute());
    return result;
}

void set_attribute(Imf::Header &header, const std::string &name, const Imf::Attribute &attribute) {
    const auto old = header.find(name);
    if (old != header.end() && std::string_view(old.attribute().typeName()) != attribute.typeName())
        header = without_attribute(header, name);
    header.insert(name, attribute);
}

} // namespace sparselens
