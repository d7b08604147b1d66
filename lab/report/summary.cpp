#include "lab/report/summary.h"

#include "lab/report/numbers.h"
#include "lab/report/verdict.h"
#include "measure/figures_text.h"

#include <fmt/format.h>

namespace sparselens::lab {

namespace {

TextRow titles() {
    return {"method",  "budget",      "rays",    "seconds", "MB",          "dB",       "focus",
            "blurred", "silhouettes", "worst",   "FLIP",    "SSIM",        "sampling", "layers",
            "flicker", "sparkle",     "largest", "x time",  "rays needed", "dB gained"};
}

TextRow cells(const ReportRow &row, const RayTracingCurves &ray_tracing) {
    TextRow text{method_name(row), row.budget, significant(row.rays, 4), significant(total_seconds(row), 3),
                 row.runs > 0 ? fixed(row.peak_mb, 0) : ""};
    for (const ErrorFigures &errors : row.errors) text.push_back(fixed(errors.psnr_tonemapped, 2));
    text.push_back(fixed(row.errors.front().psnr_worst, 2));
    text.push_back(row.errors.front().flip ? fixed(*row.errors.front().flip, 4) : "");
    text.push_back(fixed(row.errors.front().ssim, 4));
    text.push_back(row.causes ? fixed(row.causes->sampling, 2) : "");
    text.push_back(row.causes ? fixed(row.causes->layers, 2) : "");
    text.push_back(row.pull ? fmt::to_string(row.pull->above[0]) : "");
    text.push_back(row.pull ? fmt::to_string(row.pull->above[1]) : "");
    text.push_back(row.pull ? fixed(row.pull->largest, 2) : "");
    const RowVerdict verdict = row_verdict(row, ray_tracing);
    const bool compared = row.role != Role::ray_tracing && total_seconds(row) > 0;
    text.push_back(compared ? reached_text(verdict.seconds, total_seconds(row)) : "");
    text.push_back(compared ? reached_text(verdict.rays) : "");
    text.push_back(compared && verdict.equal_time ? fixed(*verdict.equal_time, 2) : "");
    return text;
}

} // namespace

std::string summary_text(std::span<const ReportRow> rows) {
    if (rows.empty()) return "";
    const RayTracingCurves ray_tracing = ray_tracing_curves(rows);
    std::vector<TextRow> table{titles()};
    for (const ReportRow &row : rows) table.push_back(cells(row, ray_tracing));
    std::string text = scene_title(rows.front()) + '\n' + text_table(table, 2);
    for (const std::string &sentence : verdict_sentences(rows, scene_verdict(rows))) text += sentence + '\n';
    return text;
}

} // namespace sparselens::lab
