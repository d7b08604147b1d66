// What people ask of a report, answered from its rows in a few lines: where other ways are better than five views, first.
//
// "Five views" are the centre and four of the rim, seen by the lens gather at normal quality. Others are compared at equal rays: their
// measured curve is interpolated, and never extrapolated.
#pragma once

#include "lab/report/row.h"

#include <span>
#include <string>
#include <vector>

namespace sparselens::lab {

struct Answer {
    std::string question;
    std::string losses; // scene by scene, where the other way is better; "nowhere"
    std::string gains;  // where five views are
};

// `scenes` are the rows of each. A question about a way that no scene has measured is left out.
std::vector<Answer> answers(std::span<const std::span<const ReportRow>> scenes);

} // namespace sparselens::lab
