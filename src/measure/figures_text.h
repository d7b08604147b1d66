// Error figures as text, of pictures and of sequences: JSON for scripts, a table for people. Numbers have a decimal
// point in every locale.
#pragma once

#include "image_error.h"
#include "temporal_error.h"

#include <algorithm>
#include <span>
#include <string>
#include <vector>

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

// "frames", "pixels", "nonfinite", "above_0.02", "above_0.05", "largest"; with a reference, also "reference" with the
// last three figures for the reference, and "psnr_change". Figures that are not finite are null.
std::string temporal_as_json(const TemporalFigures &figures);

std::string temporal_as_table(const TemporalFigures &figures);

// A table for people to read in a terminal.
using TextRow = std::vector<std::string>;

// Columns are two spaces apart; the first `left` of them are left-aligned, the others right-aligned. All rows have as
// many cells as the first. Lines have no trailing blanks.
inline std::string text_table(std::span<const TextRow> rows, std::size_t left = 1) {
    std::vector<std::size_t> widths(rows.empty() ? 0 : rows.front().size());
    for (const TextRow &row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    std::string text;
    for (const TextRow &row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string fill(widths[i] - row[i].size(), ' ');
            text += (i == 0 ? "" : "  ") + (i < left ? row[i] + fill : fill + row[i]);
        }
        text.erase(text.find_last_not_of(' ') + 1);
        text += '\n';
    }
    return text;
}

} // namespace sparselens
