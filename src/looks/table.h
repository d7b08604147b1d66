// The table of looks. A look is registered here and nowhere else: its struct becomes a part of LookValues, and its rows
// become options, keywords, keys of lens files and sliders, in this order.
#pragma once

#include "../lens/lens_looks.h"
#include "aperture_looks.h"
#include "focus_looks.h"

#include <memory>
#include <optional>
#include <span>
#include <utility>

namespace sparselens {

using AllLooks = LookTable<looks::Blades, looks::Squeeze, looks::Spherical, looks::Spherochromatism,
                           looks::CatEye, looks::AxialChromatic, looks::FieldCurvature, looks::Astigmatism,
                           looks::Tilt, looks::Breathing>;

// The values of looks, from options, a lens file or a picture's header. resolve_lens.h turns them into LensLooks, whose
// defaults apply where a value is missing.
struct LookValues : AllLooks {
    std::optional<double> highlight_gain = {}, highlight_threshold = {},
                          highlight_knee = {}; // deep/recolor.h
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
