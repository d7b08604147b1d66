// A table for people to read in a terminal.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace sparselens {

using TextRow = std::vector<std::string>;

// Columns two spaces apart: the first `left` of them flush left, the others flush right. All rows have as many
// cells as the first; no blanks at the ends of lines.
std::string text_table(std::span<const TextRow> rows, std::size_t left = 1);

} // namespace sparselens
