// The table of looks. A look is registered here and nowhere else: its struct becomes a part of LookValues
// (view/look_values.h), its rows options, keywords, keys of lens files and sliders, in this order.
#pragma once

#include "astigmatism.h"
#include "axial_chromatic.h"
#include "blades.h"
#include "breathing.h"
#include "cat_eye.h"
#include "field_curvature.h"
#include "spherical.h"
#include "spherochromatism.h"
#include "squeeze.h"
#include "tilt.h"

namespace sparselens {

using AllLooks = LookTable<looks::Blades, looks::Squeeze, looks::Spherical, looks::Spherochromatism,
                           looks::CatEye, looks::AxialChromatic, looks::FieldCurvature, looks::Astigmatism,
                           looks::Tilt, looks::Breathing>;

} // namespace sparselens
