#include "lab/report/answers.h"

#include "lab/report/curve.h"
#include "lab/report/numbers.h"
#include "lab/report/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace sparselens::lab {

namespace {

using Rows = std::span<const ReportRow>;
using Is = std::function<bool(const ReportRow &)>;

bool five_views(const ReportRow &row) { return method_name(row) == "centre + 4, lens normal"; }

Is renderer_is(const std::string &name) {
    return [name](const ReportRow &row) { return row.renderer == name; };
}

// Whether another program made the row from the centre view and its depths. Such a row has the program's options in
// parentheses.
bool of_another_program(const ReportRow &row) {
    return row.renderer == "one view" && row.processor.find('(') != std::string::npos;
}

Curve quality_by_rays(Rows rows, const Is &is) {
    std::vector<CurvePoint> points;
    for (const ReportRow &row : rows)
        if (is(row)) points.push_back({row.rays, quality(row)});
    return curve_of(points);
}

// A budget of five views for which the other way has measured as many rays, and the other way's advantage in dB.
struct Difference {
    double rays, db;
};

std::vector<Difference> differences(Rows rows, const Is &others, const Is &ours) {
    const Curve curve = quality_by_rays(rows, others);
    std::vector<Difference> result;
    for (const CurvePoint &point : quality_by_rays(rows, ours))
        if (const auto theirs = quality_at(curve, point.cost))
            result.push_back({point.cost, *theirs - point.quality});
    return result;
}

std::string list_of(const std::string &list, const std::string &entry) {
    return list.empty() ? entry : list + "; " + entry;
}

// "fence at 320 rays (4.2 dB)": the differences above 0 if `theirs`, else the others.
std::string where(const std::string &scene, const std::vector<Difference> &all, bool theirs) {
    std::string rays;
    double most = 0;
    for (const Difference &d : all)
        if (theirs ? d.db > 0 : d.db <= 0) {
            rays += (rays.empty() ? "" : ", ") + significant(d.rays, 4);
            most = std::max(most, std::abs(d.db));
        }
    return rays.empty() ? "" : fmt::format("{} at {} rays (up to {} dB)", scene, rays, fixed(most, 1));
}

void add_if_any(Answer answer, std::vector<Answer> &answers) {
    if (answer.losses.empty() && answer.gains.empty()) return;
    for (std::string *text : {&answer.losses, &answer.gains})
        if (text->empty()) *text = "nowhere";
    answers.push_back(std::move(answer));
}

void add_comparison(std::span<const Rows> scenes, const std::string &question, const Is &others,
                    const Is &ours, std::vector<Answer> &answers) {
    Answer answer{question, "", ""};
    for (const Rows rows : scenes) {
        if (rows.empty()) continue;
        const std::vector<Difference> all = differences(rows, others, ours);
        for (const bool theirs : {true, false})
            if (const std::string text = where(rows.front().scene, all, theirs); !text.empty()) {
                std::string &list = theirs ? answer.losses : answer.gains;
                list = list_of(list, text);
            }
    }
    add_if_any(std::move(answer), answers);
}

const ReportRow *best(Rows rows, const Is &is) {
    const ReportRow *found = nullptr;
    for (const ReportRow &row : rows)
        if (is(row) && (!found || quality(row) > quality(*found))) found = &row;
    return found;
}

// The cost of a note: only the gather with views, all rays again with ray tracing.
void add_notes(std::span<const Rows> scenes, std::vector<Answer> &answers) {
    Answer answer{"What does a note cost (focus, stop)?",
                  "nowhere: the views stay; a wider lens or another camera needs new ones", ""};
    for (const Rows rows : scenes) {
        const ReportRow *ours = best(rows, five_views);
        if (!ours) continue;
        const RowVerdict verdict = row_verdict(*ours, ray_tracing_curves(rows));
        answer.gains = list_of(
            answer.gains, fmt::format("{}: {} s and no ray; ray tracing of that error {} s, {} rays",
                                      ours->scene, significant(ours->seconds[std::size_t(Stage::process)], 2),
                                      reached_text(verdict.seconds), reached_text(verdict.rays)));
    }
    if (!answer.gains.empty()) answers.push_back(std::move(answer));
}

void add_programs(std::span<const Rows> scenes, std::vector<Answer> &answers) {
    Answer answer{"And other programs on one view and its depths?", "", ""};
    for (const Rows rows : scenes) {
        const ReportRow *theirs = best(rows, of_another_program);
        const ReportRow *ours =
            best(rows, [](const ReportRow &row) { return method_name(row) == "one view, lens normal"; });
        if (!theirs || !ours) continue;
        std::string &list = quality(*theirs) > quality(*ours) ? answer.losses : answer.gains;
        list = list_of(list, fmt::format("{}: {} has {} dB, this one {}", ours->scene, theirs->processor,
                                         fixed(quality(*theirs), 1), fixed(quality(*ours), 1)));
    }
    add_if_any(std::move(answer), answers);
}

} // namespace

std::vector<Answer> answers(std::span<const Rows> scenes) {
    const Is traced = [](const ReportRow &row) { return row.role == Role::ray_tracing; };
    const Is either = [](const ReportRow &row) {
        return five_views(row) || method_name(row) == "centre + 4 denoised, lens normal";
    };
    std::vector<Answer> result;
    add_comparison(scenes, "Denoised ray tracing, of as many rays?", renderer_is("denoised ray tracing"),
                   either, result);
    add_comparison(scenes, "Ray tracing the lens as it is?", traced, five_views, result);
    add_comparison(scenes, "Averages of many views?", renderer_is("accumulated lens views"), five_views,
                   result);
    add_programs(scenes, result);
    add_notes(scenes, result);
    return result;
}

} // namespace sparselens::lab
