// Temporal figures as text, like figures_text.h: JSON for scripts, a table for people.
#pragma once

#include "temporal_error.h"

#include <string>

namespace sparselens {

// "frames", "pixels", "nonfinite", "above_0.02", "above_0.05", "largest"; with a reference, also "reference" with the
// last three figures for the reference, and "psnr_change". Figures that are not finite are null.
std::string temporal_as_json(const TemporalFigures &figures);

std::string temporal_as_table(const TemporalFigures &figures);

} // namespace sparselens
