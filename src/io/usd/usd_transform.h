// Where a prim of USD stands at a time: the values of its attributes and its transformations (UsdGeomXformable).
#pragma once

#include "io/usd/usd_layer.h"

#include <Imath/ImathMatrix.h>

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens {

// A prim at a time, with the words of messages.
struct UsdPlace {
    const UsdLayer &layer;
    UsdPath path;
    double time = 0; // time code
};

// The numbers of an attribute of the last prim, linear between two time samples and constant outside of them. Empty if
// the attribute has no value. Throws Error if it has another count of numbers, or its values come from elsewhere.
std::vector<double> numbers_at(const UsdPlace &place, std::string_view name, std::size_t count);
std::optional<double> number_at(const UsdPlace &place, std::string_view name);

// From the space of the last prim to the world; acts on row vectors. Throws Error, naming the prim, for an operation
// that is not understood, and for a prim that takes contents from another file or a variant.
Imath::M44d local_to_world(const UsdPlace &place);

// The times of all samples of the prims on the path.
std::set<double> sample_times(const UsdPath &path);

// Throws Error: "FILE: PRIM: WHY".
[[noreturn]] void refuse(const UsdPlace &place, const std::string &why);

} // namespace sparselens
