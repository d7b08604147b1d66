#include "io/usd/usd_layer.h"

namespace sparselens {

namespace {

void collect(const UsdPrim &prim, std::string_view type, UsdPath &path, std::vector<UsdPath> &found) {
    for (const UsdPrim &child : prim.children) {
        if (!child.active || !child.defined) continue;
        path.push_back(&child);
        if (child.type == type) found.push_back(path);
        collect(child, type, path, found);
        path.pop_back();
    }
}

} // namespace

std::vector<UsdPath> prims_of_type(const UsdLayer &layer, std::string_view type) {
    std::vector<UsdPath> found;
    UsdPath path;
    collect(layer.root, type, path, found);
    return found;
}

std::string text_of(const UsdPath &path) {
    std::string text;
    for (const UsdPrim *prim : path) text += "/" + prim->name;
    return text;
}

const UsdAttribute *find_attribute(const UsdPrim &prim, std::string_view name) {
    const auto found = prim.attributes.find(name);
    return found == prim.attributes.end() ? nullptr : &found->second;
}

std::string text_value(const UsdPrim &prim, std::string_view name) {
    const UsdAttribute *attribute = find_attribute(prim, name);
    return attribute && attribute->value && attribute->value->texts.size() == 1 ? attribute->value->texts[0]
                                                                                : "";
}

} // namespace sparselens
