// Error figures as text: JSON for scripts, a table for people. Numbers are written with a point, whatever the
// locale.
#pragma once

#include "image_error.h"

#include <span>
#include <string>

namespace sparselens {

struct NamedFigures {
    std::string name; // of the region
    ErrorFigures figures;
};

// One object: the figures of the whole picture by name, "pixels", "nonfinite": {"image": , "reference": },
// and, where there are regions, "regions": {NAME: the same for the region}. What is infinite or unknown is
// null; other numbers keep all their digits.
std::string figures_as_json(const ErrorFigures &whole, std::span<const NamedFigures> regions);

// A row a figure, a column for the whole picture and for each region.
std::string figures_as_table(const ErrorFigures &whole, std::span<const NamedFigures> regions);

} // namespace sparselens
