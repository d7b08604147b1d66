// Error figures as text: JSON for scripts, a table for people. Numbers have a decimal point in every locale.
#pragma once

#include "image_error.h"

#include <span>
#include <string>

namespace sparselens {

struct NamedFigures {
    std::string name; // the region's name
    ErrorFigures figures;
};

// One object with the figures of the whole picture by name: "flip" if it was measured; with two references
// "psnr_without_noise" (null: too small to measure), "mse_without_noise" and "mse_deviation"; "pixels"; "nonfinite":
// {"image": , "reference": }; and, if there are regions, "regions": {NAME: the same for the region}. A figure that is
// infinite or unknown is null; other numbers keep all their digits.
std::string figures_as_json(const ErrorFigures &whole, std::span<const NamedFigures> regions);

// One row per figure, with a column for the whole picture and one for each region.
std::string figures_as_table(const ErrorFigures &whole, std::span<const NamedFigures> regions);

} // namespace sparselens
