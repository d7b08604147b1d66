// Progress lines for a terminal or for the render farm that runs the job.
#pragma once

#include "base/progress.h"
#include "base/text.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace sparselens {

enum class ProgressFormat {
    terminal, // one line that is overwritten, if stderr is a terminal, from 5 s after the start on
    none,
    plain,  // "dof-gather: 42%"
    alf,    // "ALF_PROGRESS 42%": Tractor's Alfred directive
    openjd, // "openjd_progress: 42" and "openjd_status: ...": Open Job Description
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

// Prints to stderr, because standard output may be the picture and farms read both. For a farm, the percentages refer
// to all frames and never decrease.
std::unique_ptr<Progress> progress_of(ProgressFormat format, const std::string &tool_name, FrameCount frames);

// Prepares text for a terminal: messages, and text from other programs or files.

// Returns the text as one line without control characters, whatever a library's message or the names in a file contain.
inline std::string one_line(std::string text) {
    for (char &c : text)
        if (std::iscntrl(static_cast<unsigned char>(c))) c = ' ';
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
}

// Spells the parameters in a message (error.h) as options: --depth inverse.
inline std::string with_options(std::string_view message) {
    return spelled(message, [](const std::string &name, const std::string &value) {
        std::string option = "--" + name;
        std::ranges::replace(option, '_', '-');
        return value.empty() ? option : option + " " + value;
    });
}

} // namespace sparselens
