#include "measure/figures_text.h"

#include <charconv>
#include <cmath>
#include <vector>

namespace sparselens {

namespace {

std::string shortest(double value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string six_digits(double value) {
    if (std::isnan(value)) return "-";
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, 6).ptr};
}

std::string members(const ErrorFigures &figures, const std::string &indent) {
    std::string json;
    for (const Figure &figure : figure_table) {
        const double value = figures.*figure.value;
        json +=
            indent + '"' + figure.name + "\": " + (std::isfinite(value) ? shortest(value) : "null") + ",\n";
    }
    json += indent + "\"pixels\": " + std::to_string(figures.pixels) + ",\n";
    json += indent + "\"nonfinite\": {\"image\": " + std::to_string(figures.nonfinite_image) +
            ", \"reference\": " + std::to_string(figures.nonfinite_reference) + "}";
    return json;
}

using Row = std::vector<std::string>;

// The first column flush left, the others flush right.
std::string aligned(const std::vector<Row> &rows) {
    std::vector<std::size_t> widths(rows.front().size());
    for (const Row &row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    std::string text;
    for (const Row &row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string fill(widths[i] - row[i].size(), ' ');
            text += i == 0 ? row[i] + fill : "  " + fill + row[i];
        }
        text += '\n';
    }
    return text;
}

} // namespace

std::string figures_as_json(const ErrorFigures &whole, std::span<const NamedFigures> regions) {
    std::string json = "{\n" + members(whole, "  ");
    for (std::size_t r = 0; r < regions.size(); ++r) {
        json += r == 0 ? ",\n  \"regions\": {\n" : ",\n";
        json += "    \"" + regions[r].name + "\": {\n" + members(regions[r].figures, "      ") + "\n    }";
    }
    return json + (regions.empty() ? "\n}\n" : "\n  }\n}\n");
}

std::string figures_as_table(const ErrorFigures &whole, std::span<const NamedFigures> regions) {
    std::vector<NamedFigures> columns{{"all", whole}};
    columns.insert(columns.end(), regions.begin(), regions.end());
    std::vector<Row> rows{{""}};
    for (const NamedFigures &column : columns) rows.front().push_back(column.name);
    for (const Figure &figure : figure_table) {
        Row &row = rows.emplace_back(Row{figure.name});
        for (const NamedFigures &column : columns) row.push_back(six_digits(column.figures.*figure.value));
    }
    const auto count_row = [&](const char *name, std::size_t ErrorFigures::*count) {
        Row &row = rows.emplace_back(Row{name});
        for (const NamedFigures &column : columns) row.push_back(std::to_string(column.figures.*count));
    };
    count_row("pixels", &ErrorFigures::pixels);
    count_row("nonfinite (image)", &ErrorFigures::nonfinite_image);
    count_row("nonfinite (reference)", &ErrorFigures::nonfinite_reference);
    return aligned(rows);
}

} // namespace sparselens
