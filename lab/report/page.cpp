#include "lab/report/page.h"

#include "lab/report/answers.h"
#include "lab/report/base64.h"
#include "lab/report/numbers.h"
#include "lab/report/page_assets.h"
#include "lab/report/verdict.h"

#include <fmt/format.h>

namespace sparselens::lab {

namespace {

std::string escaped(const std::string &text) {
    std::string result;
    for (const char c : text) switch (c) {
        case '&': result += "&amp;"; break;
        case '<': result += "&lt;"; break;
        case '>': result += "&gt;"; break;
        case '"': result += "&quot;"; break;
        default: result += c;
        }
    return result;
}

std::string element(const std::string &tag, const std::string &text) {
    const std::string name = tag.substr(0, tag.find(' '));
    return '<' + tag + '>' + escaped(text) + "</" + name + ">\n";
}

std::string data_url(const char *type, const std::string &bytes) {
    return std::string("data:") + type + ";base64," + base64(bytes);
}

// A choice of the picture on one side of the viewer.
std::string choice(const char *side, const std::vector<PagePicture> &pictures, std::size_t chosen) {
    std::string html = std::string("<label>") + side + " <select class=\"" + side + "\">\n";
    for (std::size_t i = 0; i < pictures.size(); ++i)
        html += element("option value=\"" + fmt::to_string(i) + '"' + (i == chosen ? " selected" : ""),
                        pictures[i].title);
    return html + "</select></label>\n";
}

// Shows one picture left of the slider and another right of it; page.js moves, flips, subtracts and zooms.
std::string viewer(const std::vector<PagePicture> &pictures) {
    if (pictures.empty()) return "";
    std::string html = "<div class=\"viewer\">\n<div class=\"controls\">\n" +
                       choice("left", pictures, pictures.size() > 1 ? 1 : 0) + choice("right", pictures, 0);
    html +=
        "<label>show <select class=\"mode\"><option value=\"slide\">slide</option>"
        "<option value=\"flip\">flip</option><option value=\"difference\">difference x 8</option>"
        "</select></label>\n"
        "<label>zoom <select class=\"zoom\"><option>1</option><option>2</option><option>4</option>"
        "<option>8</option></select></label>\n"
        "<label>slider <input class=\"slider\" type=\"range\" min=\"0\" max=\"100\" value=\"50\"></label>\n"
        "</div>\n<div class=\"frame\"><div class=\"stack\"><img class=\"below\" alt=\"right picture\">"
        "<img class=\"above\" alt=\"left picture\"></div></div>\n<div class=\"pictures\" hidden>\n";
    for (const PagePicture &picture : pictures)
        html += "<img alt=\"" + escaped(picture.title) + "\" src=\"" + data_url("image/png", picture.png) +
                "\">\n";
    return html + "</div></div>\n";
}

std::string cells(const ReportRow &row, const RayTracingCurves &ray_tracing) {
    const RowVerdict verdict = row_verdict(row, ray_tracing);
    std::string html = element("td", row.renderer) + element("td", row.processor) + element("td", row.budget);
    const auto number = [&](const std::string &text) { html += element("td class=\"n\"", text); };
    number(significant(row.rays, 4));
    number(significant(total_seconds(row), 3));
    for (const double seconds : row.seconds) number(seconds > 0 ? significant(seconds, 3) : "");
    number(row.runs > 0 ? fixed(row.peak_mb, 0) : "");
    for (const ErrorFigures &errors : row.errors) number(fixed(errors.psnr_tonemapped, 2));
    number(fixed(row.errors.front().psnr_worst, 2));
    number(row.errors.front().flip ? fixed(*row.errors.front().flip, 4) : "");
    number(fixed(row.errors.front().ssim, 4));
    number(row.causes ? fixed(row.causes->sampling, 2) : "");
    number(row.causes ? fixed(row.causes->layers, 2) : "");
    number(row.pull ? fmt::to_string(row.pull->above[0]) : "");
    number(row.pull ? fmt::to_string(row.pull->above[1]) : "");
    number(row.pull ? fixed(row.pull->largest, 2) : "");
    const bool compared = row.role != Role::ray_tracing && total_seconds(row) > 0;
    number(compared ? reached_text(verdict.seconds, total_seconds(row)) : "");
    number(compared ? reached_text(verdict.rays) : "");
    number(compared && verdict.equal_time ? fixed(*verdict.equal_time, 2) : "");
    number(fmt::to_string(row.errors.front().nonfinite_image));
    return html;
}

std::string table(std::span<const ReportRow> rows) {
    std::string html = "<div class=\"wide\"><table>\n<thead><tr>\n";
    for (const char *title : {"renderer", "processor", "budget", "rays", "seconds"})
        html += element("th", title);
    for (const char *stage : stage_names) html += element("th", stage);
    html += element("th", "peak MB") + element("th", "dB");
    for (const char *region : region_names) html += element("th", region + std::string(" dB"));
    for (const char *title : {"worst dB", "FLIP", "SSIM", "sampling dB", "layers dB", "pull: flicker",
                              "pull: sparkle", "pull: largest", "equal error: times longer",
                              "equal error: rays", "equal time: dB better", "not finite"})
        html += element("th", title);
    html += "</tr></thead>\n<tbody>\n";
    const RayTracingCurves ray_tracing = ray_tracing_curves(rows);
    for (const ReportRow &row : rows) {
        const char *kind = row.role == Role::sparse_lens   ? " class=\"sparse\""
                           : row.role == Role::ray_tracing ? " class=\"traced\""
                                                           : "";
        html += std::string("<tr") + kind + ">\n" + cells(row, ray_tracing) + "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

std::string answers_table(std::span<const PageScene> scenes) {
    std::vector<std::span<const ReportRow>> rows;
    for (const PageScene &scene : scenes) rows.push_back(scene.rows);
    const std::vector<Answer> all = answers(rows);
    if (all.empty()) return "";
    std::string html = "<table class=\"answers\">\n<thead><tr>\n" + element("th", "the question") +
                       element("th", "where that is better than five views") +
                       element("th", "where five views are") + "</tr></thead>\n<tbody>\n";
    for (const Answer &answer : all)
        html += "<tr>\n" + element("td", answer.question) + element("td", answer.losses) +
                element("td", answer.gains) + "</tr>\n";
    return html + "</tbody></table>\n";
}

std::string plots_of(const std::vector<std::string> &plots) {
    std::string html;
    for (const std::string &plot : plots)
        html += "<img class=\"plot\" alt=\"error against cost\" src=\"" + data_url("image/svg+xml", plot) +
                "\">\n";
    return html;
}

std::string on_demand(const std::string &title, const std::string &html) {
    return html.empty() ? "" : "<details>\n" + element("summary", title) + html + "</details>\n";
}

std::string worst_blocks(const std::vector<PagePicture> &blocks) {
    if (blocks.empty()) return "";
    std::string html = element("h3", "The worst places: the row on the left, the reference on the right") +
                       "<div class=\"blocks\">\n";
    for (const PagePicture &block : blocks)
        html += "<figure><img alt=\"worst block\" src=\"" + data_url("image/png", block.png) + "\">\n" +
                element("figcaption", block.title) + "</figure>\n";
    return html + "</div>\n";
}

std::string section(const PageScene &scene) {
    const std::string name = scene.rows.empty() ? "" : scene_title(scene.rows.front());
    std::string html = "<section>\n" + element("h2", name) + "<ul class=\"verdict\">\n";
    for (const std::string &sentence : scene.sentences) html += element("li", sentence);
    html += "</ul>\n" + viewer(scene.pictures);
    html +=
        plots_of(scene.plots) + on_demand("Plots of every way that was measured", plots_of(scene.more_plots));
    html += worst_blocks(scene.worst);
    return html + table(scene.rows) + "</section>\n";
}

} // namespace

std::string page_as_html(const Page &page) {
    std::string html = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                       "<title>Depth of field: error against time</title>\n<style>\n";
    html +=
        page_style + std::string("</style>\n</head>\n<body>\n<h1>Depth of field: error against time</h1>\n");
    for (const std::string &fact : page.facts) html += element("p class=\"fact\"", fact);
    html += answers_table(page.scenes);
    html +=
        "<p>Seconds are wall time, rendering included; rays are camera samples a pixel, all views together, "
        "since "
        "a production shader costs more than a test scene's. dB is PSNR of tone-mapped pixels against the "
        "reference, <i>worst</i> that of the worst 1 % of blocks of 8 x 8 pixels. FLIP is what somebody sees "
        "who "
        "flips between the two at the worst of several exposures, 0 to 1. <i>Sampling</i> is the picture "
        "against the same layers seen through many lens points, "
        "<i>layers</i> is that picture against the reference: what the layers lack. <i>Equal error</i> is "
        "what "
        "distributed ray tracing takes for a row's error, as a multiple of the row's time and in rays; "
        "&lt; and &gt; are bounds where its measured budgets end. <i>Equal time</i> is how much better the "
        "row is "
        "than ray tracing of the same time; nothing where none so short or so long was measured. <i>Pull</i> "
        "is a pull of focus to 1.1 times its "
        "distance in 16 frames: the pixels whose second difference over time exceeds 0.02 (flicker) and 0.05 "
        "(sparkle), and the largest.</p>\n";
    for (const PageScene &scene : page.scenes) html += section(scene);
    return html + "<script>\n" + page_script + "</script>\n</body>\n</html>\n";
}

} // namespace sparselens::lab
