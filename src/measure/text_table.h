// A table for people to read in a terminal.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace sparselens {

using TextRow = std::vector<std::string>;

// Columns are two spaces apart; the first `left` of them are left-aligned, the others right-aligned. All rows have as
// many cells as the first. Lines have no trailing blanks.
std::string text_table(std::span<const TextRow> rows, std::size_t left = 1);

} // namespace sparselens
