#include "lab/reporting/outputs.h"

#include "base/error.h"
#include "io/files/text_file.h"
#include "lab/report/csv.h"
#include "lab/report/numbers.h"
#include "lab/report/plot.h"
#include "lab/report/verdict.h"
#include "lab/reporting/files.h"
#include "lab/reporting/measurement.h"
#include "lab/reporting/process.h"

#include <fmt/format.h>
#include <tbb/info.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace sparselens::lab {

namespace {

namespace fs = std::filesystem;

bool is_installed(const std::string &program) {
    const char *path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (access((fs::path(folder) / program).c_str(), X_OK) == 0) return true;
    return false;
}

// Draws the plots; returns SVG files for the page.
std::vector<std::string> draw_plots(const fs::path &folder, std::span<const ReportRow> rows,
                                    const std::string &name) {
    const std::string script = name + ".gnuplot";
    write_file(folder / script, plot_script(rows, name));
    run_process({"gnuplot", script}, folder.string());
    std::vector<std::string> plots;
    for (const char *kind : {"-seconds.svg", "-rays.svg"})
        plots.push_back(read_text_file((folder / (name + kind)).string()));
    return plots;
}

std::string processor() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown processor";
}

std::string today() {
    const std::time_t now = std::time(nullptr);
    char text[32];
    return {text, std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now))};
}

} // namespace

std::string machine_fact(int threads) {
    const int used = threads > 0 ? threads : tbb::info::default_concurrency();
    return fmt::format("{}, threads: {}, {}", processor(), used, today());
}

std::string load_fact() {
    double load = 0;
    return getloadavg(&load, 1) == 1 ? fixed(load, 2) : "unknown";
}

void write_report(const std::string &folder, std::span<const MeasuredScene> scenes,
                  std::vector<std::string> facts, const ToolContext &tool) {
    const bool plots = is_installed("gnuplot");
    if (!plots) warn(tool, "gnuplot is not installed: the report has no plots");
    std::vector<ReportRow> all;
    Page page{std::move(facts), {}};
    for (const MeasuredScene &scene : scenes) {
        all.insert(all.end(), scene.rows.begin(), scene.rows.end());
        page.scenes.push_back({.rows = scene.rows,
                               .sentences = verdict_sentences(scene.rows, scene_verdict(scene.rows)),
                               .plots = {},
                               .more_plots = {},
                               .pictures = page_pictures(scene.plan, scene.rows, folder),
                               .worst = worst_places(rows_in_use(scene.rows), folder)});
        if (!plots) continue;
        const fs::path drawn = fs::path(folder) / "plots";
        page.scenes.back().plots = draw_plots(drawn, rows_in_use(scene.rows), scene.plan.name);
        page.scenes.back().more_plots = draw_plots(drawn, scene.rows, scene.plan.name + "-all");
    }
    write_file(fs::path(folder) / "report.csv", report_as_csv(all));
    write_file(fs::path(folder) / "index.html", page_as_html(page));
}

} // namespace sparselens::lab
