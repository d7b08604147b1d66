#include "measure/figures_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace sparselens {

namespace {

std::string six_digits(double value) { return std::isnan(value) ? "-" : fmt::format("{:.6g}", value); }

// If the error is too small for the references to show, a limit that it stays below.
std::string decibels_text(const ErrorWithoutNoise &error) {
    if (error.is_told()) return six_digits(error.decibels());
    const double bound = error.at_least();
    return std::isnan(bound) ? "-" : "> " + six_digits(bound);
}

using Json = nlohmann::ordered_json;

// Numbers keep all their digits. Values that are not finite become null, because JSON has no infinity.
Json json_of(const ErrorFigures &figures) {
    Json json;
    for (const Figure &figure : figure_table) json[figure.name] = figures.*figure.value;
    if (const auto &error = figures.without_noise) {
        json["psnr_without_noise"] = error->is_told() ? Json(error->decibels()) : Json(nullptr);
        json["mse_without_noise"] = error->mean_square;
        json["mse_deviation"] = error->deviation;
    }
    json["pixels"] = figures.pixels;
    json["nonfinite"] = {{"image", figures.nonfinite_image}, {"reference", figures.nonfinite_reference}};
    return json;
}

} // namespace

std::string figures_as_json(const ErrorFigures &whole, std::span<const NamedFigures> regions) {
    Json json = json_of(whole);
    for (const NamedFigures &region : regions) json["regions"][region.name] = json_of(region.figures);
    return json.dump(2) + '\n';
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
    if (whole.without_noise) {
        TextRow &row = rows.emplace_back(TextRow{"psnr_without_noise"});
        for (const NamedFigures &column : columns)
            row.push_back(decibels_text(column.figures.without_noise.value_or(ErrorWithoutNoise())));
    }
    const auto count_row = [&](const char *name, std::size_t ErrorFigures::*count) {
        TextRow &row = rows.emplace_back(TextRow{name});
        for (const NamedFigures &column : columns) row.push_back(fmt::to_string(column.figures.*count));
    };
    count_row("pixels", &ErrorFigures::pixels);
    count_row("nonfinite (image)", &ErrorFigures::nonfinite_image);
    count_row("nonfinite (reference)", &ErrorFigures::nonfinite_reference);
    return text_table(rows);
}

namespace {

using Json = nlohmann::ordered_json;

std::string name_of(double threshold) { return fmt::format("above_{:g}", threshold); }

void put(Json &json, const Steadiness &of) {
    for (std::size_t k = 0; k < of.above.size(); ++k) json[name_of(temporal_thresholds[k])] = of.above[k];
    json["largest"] = of.largest;
}

} // namespace

std::string temporal_as_json(const TemporalFigures &figures) {
    Json json{{"frames", figures.frames}, {"pixels", figures.pixels}, {"nonfinite", figures.nonfinite}};
    put(json, figures.image);
    if (figures.reference) put(json["reference"], *figures.reference);
    if (figures.psnr_change) json["psnr_change"] = *figures.psnr_change;
    return json.dump(2) + '\n';
}

std::string temporal_as_table(const TemporalFigures &figures) {
    const auto row = [&](const std::string &name, const auto &value) {
        TextRow cells{name, fmt::format("{:.6g}", double(value(figures.image)))};
        if (figures.reference) cells.push_back(fmt::format("{:.6g}", double(value(*figures.reference))));
        return cells;
    };
    std::vector<TextRow> rows{{"", "picture"}};
    if (figures.reference) rows.front().push_back("reference");
    for (std::size_t k = 0; k < temporal_thresholds.size(); ++k)
        rows.push_back(
            row(name_of(temporal_thresholds[k]), [k](const Steadiness &of) { return of.above[k]; }));
    rows.push_back(row("largest", [](const Steadiness &of) { return of.largest; }));
    if (figures.psnr_change) rows.push_back({"psnr_change", fmt::format("{:.6g}", *figures.psnr_change)});
    rows.push_back({"frames", fmt::to_string(figures.frames)});
    rows.push_back({"pixels", fmt::to_string(figures.pixels)});
    rows.push_back({"nonfinite", fmt::to_string(figures.nonfinite)});
    for (TextRow &cells : rows) cells.resize(rows.front().size());
    return text_table(rows);
}

} // namespace sparselens
