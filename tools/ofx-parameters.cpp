// ofx-parameters: prints the table of parameters as rows of plugins/openfx/parameter_table.h. A build runs it; it is not
// installed.
#include "base/text.h"
#include "chain/parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <string>
#include <string_view>

using namespace sparselens;

namespace {

// The host chooses the pixels, their number and their channels. No point of the lens means that none is given.
constexpr std::array left_out{"proxy", "region", "channels", "lens-point"};

const char *kind_of(const Parameter &row) {
    switch (row.form) {
    case ParameterForm::flag: return "flag";
    case ParameterForm::whole: return "whole";
    case ParameterForm::number: return row.control.whole_from > 0 ? "whole" : "number";
    case ParameterForm::pair: return "pair";
    case ParameterForm::word: return "choice";
    case ParameterForm::file:
    case ParameterForm::ldi: return "file";
    default: return "text";
    }
}

bool has_slider(const Parameter &row) { return *row.control.label != '\0'; }

// The number that leaves the choice to the file or the method.
double nothing_of(const Parameter &row) {
    if (row.form != ParameterForm::number) return 0;
    if (has_slider(row)) return row.control.usual;
    return row.range.holds(0) ? -1 : 0;
}

double high_of(const Parameter &row) {
    constexpr double usual = 100;
    if (row.form == ParameterForm::whole) return std::min(double(row.most), usual);
    return has_slider(row) && row.control.high > row.control.low ? row.control.high : usual;
}

std::string label_of(const Parameter &row) {
    std::string label = has_slider(row) ? row.control.label : row.name;
    if (!has_slider(row)) std::ranges::replace(label, '-', ' ');
    label[0] = char(std::toupper(static_cast<unsigned char>(label[0])));
    return label;
}

std::string needed_by(const Parameter &row) {
    for (const Parameter *other : picture_parameters())
        if (needs(row.name, other->name)) return keyword_of(other->name);
    return {};
}

std::string literal(std::string_view text) { return fmt::format("R\"ofx({})ofx\"", text); }

void print(const Parameter &row) {
    const std::string help = spelled(row.help, [](const std::string &name, const std::string &value) {
        return value.empty() ? name : name + " " + value;
    });
    // The parameters that a page shows first are outside the groups.
    const bool first = row.page && !has_slider(row);
    fmt::print("{{{}, {}, {}, {}, ParameterKind::{}, {}, {}, {}, {}, {}, {}}},\n",
               literal(keyword_of(row.name)), literal(label_of(row)), literal(help),
               literal(first ? "" : row.group), kind_of(row), nothing_of(row),
               std::min(nothing_of(row), row.control.low), high_of(row), row.keyable, literal(needed_by(row)),
               literal(fmt::format("{}", fmt::join(row.words, "|"))));
}

} // namespace

int main() {
    for (const Parameter *row : picture_parameters())
        if (!is_among(left_out, row->name)) print(*row);
    return std::fflush(stdout) == 0 ? 0 : 1;
}
