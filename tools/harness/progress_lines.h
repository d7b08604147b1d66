// Progress lines for a terminal or for the render farm that runs the job.
#pragma once

#include "base/progress.h"
#include "harness/in_turn.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

namespace sparselens {

enum class ProgressFormat {
    terminal, // one line that is overwritten, if stderr is a terminal
    plain,    // "dof-gather: 42%"
    alf,      // "ALF_PROGRESS 42%": Tractor's Alfred directive
    openjd,   // "openjd_progress: 42" and "openjd_status: ...": Open Job Description
};

// The number of finished frames, the number of all frames, and the number of the current frame in a range.
struct FrameCount {
    std::size_t done = 0, all = 1;
    std::optional<int> number = {};
};

// The percentage of all frames when the current frame is at `percent`.
int overall_percent(const FrameCount &frames, int percent);

// The line for a farm, without a line feed.
std::string progress_line(ProgressFormat format, const std::string &tool_name, int percent);

// The current stage as Open Job Description prints it, without a line feed: "openjd_status: dof-gather: frame 12 (2 of
// 24): gathering".
std::string status_line(const std::string &tool_name, const FrameCount &frames, const std::string &stage);

// The beginning of an error line: "dof-gather: ", for Open Job Description "openjd_fail: dof-gather: ".
std::string error_prefix(ProgressFormat format, const std::string &tool_name);

// Prints to stderr when the frame's turn comes, because standard output may be the picture and farms read both. For a
// farm, the percentages refer to all frames and never decrease.
std::unique_ptr<Progress> progress_of(ProgressFormat format, const std::string &tool_name, FrameCount frames,
                                      const std::shared_ptr<InTurn> &turn, Progress::Watch watch = {});

} // namespace sparselens
