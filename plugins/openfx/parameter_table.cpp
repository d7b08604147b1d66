#include "parameter_table.h"

#include <algorithm>

namespace sparselens_ofx {

namespace {

constexpr ParameterRow rows[] = {
#include <parameter_rows.inc> // made by the build
};

} // namespace

std::span<const ParameterRow> parameter_table() { return rows; }

std::vector<std::string> words_of(const ParameterRow &row) {
    std::vector<std::string> words;
    for (std::string_view left = row.words; !left.empty();) {
        const std::size_t end = std::min(left.find('|'), left.size());
        words.emplace_back(left.substr(0, end));
        left.remove_prefix(std::min(end + 1, left.size()));
    }
    return words;
}

std::string setting_of(std::string_view name) {
    std::string setting(name);
    std::ranges::replace(setting, '_', '-');
    return setting;
}

std::string name_x(const ParameterRow &row) { return std::string(row.name) + "_x"; }
std::string name_y(const ParameterRow &row) { return std::string(row.name) + "_y"; }

} // namespace sparselens_ofx
