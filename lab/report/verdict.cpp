#include "lab/report/verdict.h"

#include "lab/report/numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sparselens::lab {

namespace {

// Whether `a` is no slower and no worse than `b`, and better in one of the two.
bool beats(const ReportRow &a, const ReportRow &b) {
    const double ta = total_seconds(a), tb = total_seconds(b), qa = quality(a), qb = quality(b);
    return ta <= tb && qa >= qb && (ta < tb || qa > qb);
}

std::optional<Beaten> beaten_by_others(std::span<const ReportRow> rows, std::size_t row) {
    std::vector<std::size_t> better;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (rows[i].role != Role::sparse_lens && beats(rows[i], rows[row])) better.push_back(i);
    if (better.empty()) return {};
    const auto best = std::ranges::max_element(better, {}, [&](std::size_t i) { return quality(rows[i]); });
    return Beaten{row, *best, better.size() - 1};
}

// Whether a time is before the crossing. Beyond it ray tracing is the better choice, and no other comparison matters.
bool below(const Reached &crossing, double seconds) {
    return crossing.bound != Reached::exactly || seconds < crossing.cost;
}

std::string row_text(const ReportRow &row) { return method_name(row) + " at " + row.budget; }

std::string figures_text(const ReportRow &row) {
    return fixed(quality(row), 2) + " dB in " + significant(total_seconds(row), 3) + " s, " +
           significant(row.rays, 4) + " rays a pixel";
}

std::string beaten_sentence(std::span<const ReportRow> rows, const Beaten &beaten) {
    const std::string others = beaten.others == 0   ? ""
                               : beaten.others == 1 ? ", as is another row"
                                                    : fmt::format(", as are {} other rows", beaten.others);
    return row_text(rows[beaten.row]) + " (" + figures_text(rows[beaten.row]) +
           ") is a poor choice: " + row_text(rows[beaten.by]) + " (" + figures_text(rows[beaten.by]) +
           ") is no slower and no worse" + others + ".";
}

std::string crossing_sentence(const SceneVerdict &verdict, double best_seconds) {
    const auto cost = [](const Reached &at, const char *unit) { return significant(at.cost, 3) + unit; };
    const Reached &time = verdict.crossing_seconds, &rays = verdict.crossing_rays;
    const std::string both = cost(time, " s") + ", " + cost(rays, " rays a pixel");
    switch (time.bound) {
    case Reached::exactly:
        return "Ray tracing the lens passes it at " + both +
               ": for less error than that, ray tracing the lens is the better choice.";
    case Reached::at_most:
        return "Ray tracing the lens is better from its smallest measured budget on (" + both +
               "): it is the better choice here.";
    case Reached::beyond:
        return "Ray tracing the lens does not reach it with the largest measured budget (" + both + ")" +
               (best_seconds > time.cost
                    ? ", which is less time than it takes itself: which of the two is better there "
                      "was not measured."
                    : ".");
    case Reached::unknown: break;
    }
    return "No ray tracing of the lens was measured.";
}

} // namespace

RayTracingCurves ray_tracing_curves(std::span<const ReportRow> rows) {
    std::vector<CurvePoint> seconds, rays;
    for (const ReportRow &row : rows)
        if (row.role == Role::ray_tracing) {
            seconds.push_back({total_seconds(row), quality(row)});
            rays.push_back({row.rays, quality(row)});
        }
    return {curve_of(seconds), curve_of(rays)};
}

RowVerdict row_verdict(const ReportRow &row, const RayTracingCurves &ray_tracing) {
    RowVerdict verdict{
        reached_at(ray_tracing.by_seconds, quality(row)), reached_at(ray_tracing.by_rays, quality(row)), {}};
    if (const auto theirs = quality_at(ray_tracing.by_seconds, total_seconds(row)))
        verdict.equal_time = quality(row) - *theirs;
    return verdict;
}

SceneVerdict scene_verdict(std::span<const ReportRow> rows) {
    SceneVerdict verdict;
    std::vector<std::size_t> ours;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (rows[i].role == Role::sparse_lens) ours.push_back(i);
    if (ours.empty()) return verdict;
    verdict.best = *std::ranges::max_element(ours, {}, [&](std::size_t i) { return quality(rows[i]); });

    const RayTracingCurves curves = ray_tracing_curves(rows);
    verdict.crossing_seconds = reached_at(curves.by_seconds, quality(rows[*verdict.best]));
    verdict.crossing_rays = reached_at(curves.by_rays, quality(rows[*verdict.best]));
    for (const std::size_t i : ours) {
        const RowVerdict row = row_verdict(rows[i], curves);
        if (row.equal_time && *row.equal_time < 0) verdict.slower.push_back(i);
        if (!below(verdict.crossing_seconds, total_seconds(rows[i]))) continue;
        ++verdict.below;
        if (const auto beaten = beaten_by_others(rows, i)) verdict.beaten.push_back(*beaten);
    }
    return verdict;
}

std::string reached_text(const Reached &reached, double scale) {
    if (reached.bound == Reached::unknown) return "-";
    const char *sign = reached.bound == Reached::at_most  ? "< "
                       : reached.bound == Reached::beyond ? "> "
                                                          : "";
    return sign + significant(reached.cost / scale, 3);
}

std::vector<std::string> verdict_sentences(std::span<const ReportRow> rows, const SceneVerdict &verdict) {
    if (!verdict.best) return {"No sparse views seen through the lens were measured."};
    const ReportRow &best = rows[*verdict.best];
    std::vector<std::string> text{"Least error of sparse views: " + row_text(best) + ", " +
                                  figures_text(best) + "."};
    text.push_back(crossing_sentence(verdict, total_seconds(best)));
    std::string slower;
    for (const std::size_t i : verdict.slower) slower += (slower.empty() ? "" : "; ") + row_text(rows[i]);
    if (!slower.empty())
        text.push_back(
            "For the time of these, ray tracing the lens has less error and is the better choice: " + slower +
            ".");
    for (const Beaten &beaten : verdict.beaten) text.push_back(beaten_sentence(rows, beaten));
    if (verdict.below == 0)
        text.push_back("No sparse row with the lens gather takes less time than that.");
    else if (verdict.beaten.empty())
        text.push_back(
            std::string(verdict.crossing_seconds.bound == Reached::exactly ? "In less time than that, no"
                                                                           : "No") +
            " other system measured is both faster and better than any sparse row with the lens gather.");
    return text;
}

} // namespace sparselens::lab
