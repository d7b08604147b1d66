// A table for people to read in a terminal.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

namespace sparselens {

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
