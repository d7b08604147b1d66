#include "measure/temporal_text.h"

#include "measure/text_table.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <vector>

namespace sparselens {

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
