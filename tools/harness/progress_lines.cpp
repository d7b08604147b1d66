#include "harness/progress_lines.h"

#include <unistd.h>

#include <cstdio>
#include <mutex>

namespace sparselens {

namespace {

Progress::Listener terminal_listener(const std::string &tool_name) {
    if (!isatty(STDERR_FILENO)) return {};
    return [tool_name](const std::string &stage, int percent) {
        std::fprintf(stderr, "\r%s: %s %3d%%%s", tool_name.c_str(), stage.c_str(), percent,
                     percent == 100 ? "\n" : "");
    };
}

// What threads reach out of order is said in order.
struct Said {
    std::mutex guard;
    int percent = -1;
};

Progress::Listener farm_listener(ProgressFormat format, const std::string &tool_name, FrameCount frames) {
    const int before = overall_percent(frames, 0);
    auto said = std::make_shared<Said>();
    said->percent = frames.done > 0 ? before : -1; // the frame before has said so
    return [=](const std::string &, int percent) {
        const std::lock_guard lock(said->guard);
        const int overall = overall_percent(frames, percent);
        if (overall <= said->percent) return;
        said->percent = overall;
        std::fprintf(stderr, "%s\n", progress_line(format, tool_name, overall).c_str());
    };
}

} // namespace

int overall_percent(const FrameCount &frames, int percent) {
    return int((frames.done * 100 + std::size_t(percent)) / frames.all);
}

std::string progress_line(ProgressFormat format, const std::string &tool_name, int percent) {
    const std::string number = std::to_string(percent);
    switch (format) {
    case ProgressFormat::alf: return "ALF_PROGRESS " + number + "%";
    case ProgressFormat::openjd: return "openjd_progress: " + number;
    case ProgressFormat::terminal:
    case ProgressFormat::plain: break;
    }
    return tool_name + ": " + number + "%";
}

std::unique_ptr<Progress> progress_of(ProgressFormat format, const std::string &tool_name,
                                      FrameCount frames) {
    return std::make_unique<Progress>(format == ProgressFormat::terminal
                                          ? terminal_listener(tool_name)
                                          : farm_listener(format, tool_name, frames));
}

} // namespace sparselens
