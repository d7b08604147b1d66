// Answers people's questions about a report in a few lines, from its rows; cases where other ways are better than five
// views come first.
//
// "Five views" are the centre view and four rim views, gathered by the lens gather at normal quality. Other ways are
// compared at equal rays: their measured curve is interpolated, never extrapolated.
#pragma once

#include "lab/report/row.h"

#include <span>
#include <string>
#include <vector>

namespace sparselens::lab {

struct Answer {
    std::string question;
    std::string losses; // scenes where the other way is better; "nowhere"
    std::string gains;  // scenes where five views are better
};

// `scenes`: the rows of each scene. Questions about ways that no scene has measured are left out.
std::vector<Answer> answers(std::span<const std::span<const ReportRow>> scenes);

} // namespace sparselens::lab
