// The looks of a lens as options, a lens file or a picture's header give them. looks/table.h lists them, with names and
// ranges; resolve_looks.h turns them into LensLooks, whose defaults apply where a value is missing.
#pragma once

#include "../lens/aperture_shape.h"
#include "../looks/table.h"

#include <memory>
#include <optional>
#include <span>
#include <utility>

namespace sparselens {

struct LookValues : AllLooks {
    std::optional<double> highlight_gain = {}, highlight_threshold = {},
                          highlight_knee = {}; // deep/highlight_gain.h
    std::shared_ptr<const AperturePicture> picture = {};
};

using LookNumber = LookRow<LookValues>;
std::span<const LookNumber> look_numbers();      // effects of the lens
std::span<const LookNumber> highlight_numbers(); // brighter lights, applied before any lens

// The types by name.
std::span<const std::pair<const char *, ChromaticType>> chromatic_types();

bool is_tilt(double degrees); // between -89 and 89

// The values of `above`; values that it lacks come from `below`. Blades in one replace an aperture picture in the
// other, and vice versa.
LookValues look_values_over(const LookValues &above, const LookValues &below);

} // namespace sparselens
