#include "measure/figures_text.h"

#include "measure/text_table.h"

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
    std::vector<TextRow> rows{{""}};
    for (const NamedFigures &column : columns) rows.front().push_back(column.name);
    for (const Figure &figure : figure_table) {
        TextRow &row = rows.emplace_back(TextRow{figure.name});
        for (const NamedFigures &column : columns) row.push_back(six_digits(column.figures.*figure.value));
    }
    const auto count_row = [&](const char *name, std::size_t ErrorFigures::*count) {
        TextRow &row = rows.emplace_back(TextRow{name});
        for (const NamedFigures &column : columns) row.push_back(std::to_string(column.figures.*count));
    };
    count_row("pixels", &ErrorFigures::pixels);
    count_row("nonfinite (image)", &ErrorFigures::nonfinite_image);
    count_row("nonfinite (reference)", &ErrorFigures::nonfinite_reference);
    return text_table(rows);
}

} // namespace sparselens
