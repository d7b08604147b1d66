#include "harness/progress_lines.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <mutex>

namespace sparselens {

namespace {

Progress::Listener terminal_listener(const std::string &tool_name) {
    if (!isatty(STDERR_FILENO)) return {};
    return [tool_name](const std::string &stage, int percent) {
        fmt::print(stderr, "\r{}: {} {:3}%{}", tool_name, stage, percent, percent == 100 ? "\n" : "");
    };
}

// The last percentage that was printed: threads may reach theirs out of order.
struct Said {
    std::mutex guard;
    int percent = -1;
};

Progress::Listener farm_listener(ProgressFormat format, const std::string &tool_name, FrameCount frames) {
    const int before = overall_percent(frames, 0);
    auto said = std::make_shared<Said>();
    said->percent = frames.done > 0 ? before : -1; // the frame before has printed it
    return [=](const std::string &, int percent) {
        const std::lock_guard lock(said->guard);
        const int overall = overall_percent(frames, percent);
        if (overall <= said->percent) return;
        said->percent = overall;
        fmt::print(stderr, "{}\n", progress_line(format, tool_name, overall));
    };
}

} // namespace

int overall_percent(const FrameCount &frames, int percent) {
    return int((frames.done * 100 + std::size_t(percent)) / frames.all);
}

std::string progress_line(ProgressFormat format, const std::string &tool_name, int percent) {
    switch (format) {
    case ProgressFormat::alf: return fmt::format("ALF_PROGRESS {}%", percent);
    case ProgressFormat::openjd: return fmt::format("openjd_progress: {}", percent);
    case ProgressFormat::terminal:
    case ProgressFormat::plain: break;
    }
    return fmt::format("{}: {}%", tool_name, percent);
}

std::unique_ptr<Progress> progress_of(ProgressFormat format, const std::string &tool_name,
                                      FrameCount frames) {
    return std::make_unique<Progress>(format == ProgressFormat::terminal
                                          ? terminal_listener(tool_name)
                                          : farm_listener(format, tool_name, frames));
}

} // namespace sparselens
