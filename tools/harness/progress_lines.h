// Progress for whoever watches: a terminal, or the farm that runs the job.
#pragma once

#include "base/progress.h"

#include <cstddef>
#include <memory>
#include <string>

namespace sparselens {

enum class ProgressFormat {
    terminal, // one line, rewritten, where stderr is a terminal
    plain,    // "dof-gather: 42%"
    alf,      // "ALF_PROGRESS 42%": Tractor's Alfred directive
    openjd,   // "openjd_progress: 42": Open Job Description
};

// How far a range of frames is.
struct FrameCount {
    std::size_t done = 0, all = 1;
};

// Percent of all frames, where the one being worked on is at `percent`.
int overall_percent(const FrameCount &frames, int percent);

// The line that tells a farm; no line feed.
std::string progress_line(ProgressFormat format, const std::string &tool_name, int percent);

// On stderr: standard output may be the picture, and farms read both. For a farm, percents of all frames that
// only grow.
std::unique_ptr<Progress> progress_of(ProgressFormat format, const std::string &tool_name, FrameCount frames);

} // namespace sparselens
