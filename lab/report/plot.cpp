#include "lab/report/plot.h"

#include "lab/report/numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace sparselens::lab {

namespace {

struct Line {
    std::string title;
    Role role;
    std::vector<const ReportRow *> rows; // by time
};

std::vector<Line> lines_of(std::span<const ReportRow> rows) {
    std::vector<Line> lines;
    for (const ReportRow &row : rows) {
        const std::string title = method_name(row);
        auto line = std::ranges::find(lines, title, &Line::title);
        if (line == lines.end()) line = lines.insert(line, {title, row.role, {}});
        line->rows.push_back(&row);
    }
    for (Line &line : lines)
        std::ranges::stable_sort(line.rows, {}, [](const ReportRow *row) { return total_seconds(*row); });
    return lines;
}

// Seconds, rays, root mean square error. Equal pictures are left out, because an error of 0 is not on a logarithmic
// axis.
std::string data_block(const Line &line, std::size_t number) {
    std::string text = fmt::format("$line{} << END\n", number);
    for (const ReportRow *row : line.rows)
        if (std::isfinite(quality(*row)) && total_seconds(*row) > 0)
            text += significant(total_seconds(*row), 6) + ' ' + significant(row->rays, 6) + ' ' +
                    significant(std::pow(10, -quality(*row) / 20), 6) + '\n';
    return text + "END\n";
}

// In double quotes, gnuplot takes $ and ` literally in noenhanced titles; only these two characters need an escape.
std::string quoted(const std::string &text) {
    std::string result = "\"";
    for (const char c : text) result += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    return result + '"';
}

std::string style(const Line &line, std::size_t number) {
    const char *colours[] = {"#4477aa", "#66ccee", "#228833", "#ccbb44", "#aa3377", "#bbbbbb", "#885522"};
    const std::string point = fmt::format(" pt {}", 4 + number % 11);
    switch (line.role) {
    case Role::ray_tracing: return "lc rgb \"#000000\" lw 2.5 pt 7 ps 0.7";
    case Role::sparse_lens:
        return fmt::format("lc rgb \"#ee3311\" lw 2 dt {}{} ps 0.7", 1 + number % 4, point);
    case Role::other: break;
    }
    return fmt::format("lc rgb \"{}\" lw 1{} ps 0.6", colours[number % std::size(colours)], point);
}

// Decibels are linear where the error is logarithmic, so the right axis is aligned with the left one.
std::string ranges(std::span<const ReportRow> rows) {
    double low = std::numeric_limits<double>::infinity(), high = -low; // dB
    for (const ReportRow &row : rows)
        if (std::isfinite(quality(row)))
            low = std::min(low, quality(row)), high = std::max(high, quality(row));
    if (!(low <= high)) return "";
    low = 5 * std::floor((low - 0.5) / 5);
    high = 5 * std::ceil((high + 0.5) / 5);
    const auto error = [](double db) { return significant(std::pow(10, -db / 20), 6); };
    return "set yrange [" + error(high) + ":" + error(low) + "]\nset y2range [" + fixed(high, 0) + ":" +
           fixed(low, 0) + "]\n";
}

std::string plot_command(const std::vector<Line> &lines, const char *columns) {
    std::string text;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        text += i == 0 ? "plot " : ", \\\n     ";
        text += fmt::format("$line{} using {} with linespoints {}", i, columns, style(lines[i], i));
        text += " title " + quoted(lines[i].title);
    }
    return text + '\n';
}

} // namespace

std::vector<ReportRow> rows_in_use(std::span<const ReportRow> rows) {
    constexpr std::size_t most = 6;
    std::vector<std::string> used;
    for (const char *name :
         {"distributed ray tracing", "denoised ray tracing", "centre + 4, lens normal",
          "accumulated lens views", "one view, lens normal", "centre + 4 denoised, lens normal",
          "centre + 4 planned, lens normal", "centre + 8, lens normal"})
        if (used.size() < most &&
            std::ranges::any_of(rows, [&](const ReportRow &row) { return method_name(row) == name; }))
            used.push_back(name);
    std::vector<ReportRow> kept;
    std::ranges::copy_if(rows, std::back_inserter(kept), [&](const ReportRow &row) {
        return std::ranges::find(used, method_name(row)) != used.end();
    });
    return kept;
}

std::string plot_script(std::span<const ReportRow> rows, const std::string &name) {
    const std::vector<Line> lines = lines_of(rows);
    std::string text = "# error against cost; run by gnuplot in the folder of the plots\n"
                       "set encoding utf8\nset logscale xy\nset grid xtics y2tics lc rgb \"#dddddd\"\n"
                       "set key outside right top Left reverse noenhanced samplen 2 spacing 0.9 font \",9\"\n"
                       "set ylabel \"root mean square error, tone-mapped\"\nset ytics nomirror\n"
                       "set y2tics 5\nset y2label \"PSNR, dB\"\n" +
                       ranges(rows);
    for (std::size_t i = 0; i < lines.size(); ++i) text += data_block(lines[i], i);
    const auto pictures = [&](const std::string &kind, const char *label, const char *columns) {
        text += "set xlabel \"" + std::string(label) + "\"\nset title " +
                quoted(rows.empty() ? name : scene_title(rows.front()) + ": error against " + kind) +
                " noenhanced\n";
        for (const char *terminal : {"svg", "pngcairo"}) {
            const std::string suffix = terminal == std::string("svg") ? ".svg" : ".png";
            text += "set terminal " + std::string(terminal) + " size 1000,560 background \"#ffffff\"\n" +
                    "set output \"" + name + '-' + kind + suffix + "\"\n" + plot_command(lines, columns);
        }
    };
    pictures("seconds", "seconds, rendering included", "1:3");
    pictures("rays", "camera samples a pixel, all views together", "2:3");
    return text + "unset output\n";
}

} // namespace sparselens::lab
