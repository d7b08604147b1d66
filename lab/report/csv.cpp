#include "lab/report/csv.h"

#include "lab/report/numbers.h"
#include "lab/report/verdict.h"

#include <fmt/format.h>

#include <algorithm>

namespace sparselens::lab {

namespace {

using Fields = std::vector<std::pair<std::string, std::string>>; // column and value

std::string quoted(const std::string &text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? "\"\"" : std::string(1, c);
    return result + '"';
}

std::string line_of(const Fields &fields, std::string Fields::value_type::*part) {
    std::string line;
    for (const auto &field : fields) line += (line.empty() ? "" : ",") + quoted(field.*part);
    return line + '\n';
}

// Only an interpolated value is exact. Bounds are left to the page, which can mark them.
std::string exact(const Reached &reached) {
    return reached.bound == Reached::exactly ? shortest(reached.cost) : "";
}

void add_errors(const std::string &prefix, const ErrorFigures &errors, Fields &fields) {
    for (const Figure &figure : figure_table)
        fields.emplace_back(prefix + figure.name, shortest(errors.*figure.value));
    fields.emplace_back(prefix + "flip", errors.flip ? shortest(*errors.flip) : "");
    fields.emplace_back(prefix + "pixels", fmt::to_string(errors.pixels));
    fields.emplace_back(prefix + "nonfinite_image", fmt::to_string(errors.nonfinite_image));
    fields.emplace_back(prefix + "nonfinite_reference", fmt::to_string(errors.nonfinite_reference));
}

Fields fields_of(const ReportRow &row, const RayTracingCurves &ray_tracing) {
    Fields fields{{"scene", row.scene},         {"renderer", row.renderer},
                  {"processor", row.processor}, {"budget", row.budget},
                  {"size", row.size},           {"views", fmt::to_string(row.views)},
                  {"rays", shortest(row.rays)}, {"seconds", shortest(total_seconds(row))}};
    for (std::size_t s = 0; s < stage_names.size(); ++s)
        fields.emplace_back(std::string("seconds_") + stage_names[s], shortest(row.seconds[s]));
    fields.emplace_back("runs", fmt::to_string(row.runs));
    fields.emplace_back("peak_mb", row.runs > 0 ? shortest(row.peak_mb) : "");
    add_errors("", row.errors.front(), fields);
    for (std::size_t r = 0; r < region_names.size(); ++r)
        add_errors(region_names[r] + std::string("_"), row.errors[r + 1], fields);
    fields.emplace_back("psnr_sampling", row.causes ? shortest(row.causes->sampling) : "");
    fields.emplace_back("psnr_layers", row.causes ? shortest(row.causes->layers) : "");
    fields.emplace_back("pull_flickering_pixels", row.pull ? fmt::to_string(row.pull->above[0]) : "");
    fields.emplace_back("pull_sparkling_pixels", row.pull ? fmt::to_string(row.pull->above[1]) : "");
    fields.emplace_back("pull_largest", row.pull ? shortest(row.pull->largest) : "");
    const RowVerdict verdict = row_verdict(row, ray_tracing);
    fields.emplace_back("equal_error_seconds", exact(verdict.seconds));
    fields.emplace_back("equal_error_rays", exact(verdict.rays));
    fields.emplace_back("equal_time_db", verdict.equal_time ? shortest(*verdict.equal_time) : "");
    fields.emplace_back("picture", row.picture);
    fields.emplace_back("difference", row.difference);
    return fields;
}

} // namespace

std::vector<std::span<const ReportRow>> by_scene(std::span<const ReportRow> rows) {
    std::vector<std::span<const ReportRow>> scenes;
    while (!rows.empty()) {
        const auto end =
            std::ranges::find_if(rows, [&](const ReportRow &row) { return row.scene != rows.front().scene; });
        const auto count = std::size_t(end - rows.begin());
        scenes.push_back(rows.first(count));
        rows = rows.subspan(count);
    }
    return scenes;
}

std::string report_as_csv(std::span<const ReportRow> rows) {
    std::string text = line_of(fields_of({}, {}), &Fields::value_type::first);
    for (const std::span<const ReportRow> scene : by_scene(rows)) {
        const RayTracingCurves ray_tracing = ray_tracing_curves(scene);
        for (const ReportRow &row : scene)
            text += line_of(fields_of(row, ray_tracing), &Fields::value_type::second);
    }
    return text;
}

} // namespace sparselens::lab
