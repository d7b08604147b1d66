#include "harness/progress_lines.h"

#include "base/system/system.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <mutex>

namespace sparselens {

namespace {

Progress::Listener terminal_listener(const std::string &tool_name) {
    using Clock = std::chrono::steady_clock;
    static const auto from = Clock::now() + std::chrono::seconds(5); // short work shows none
    if (!system::is_terminal(system::standard_error)) return {};
    return [tool_name](const std::string &stage, int percent) {
        if (Clock::now() >= from)
            fmt::print(stderr, "\r{}: {} {:3}%\x1b[K{}", tool_name, stage, percent,
                       percent == 100 ? "\n" : "");
    };
}

// The last printed state: threads may report their percentages out of order.
struct Said {
    std::mutex guard;
    int percent = -1;
    std::string stage;
};

Progress::Listener farm_listener(ProgressFormat format, const std::string &tool_name, FrameCount frames) {
    const int before = overall_percent(frames, 0);
    auto said = std::make_shared<Said>();
    said->percent = frames.done > 0 ? before : -1; // the frame before has printed it
    return [=](const std::string &stage, int percent) {
        const std::lock_guard lock(said->guard);
        if (format == ProgressFormat::openjd && stage != said->stage)
            fmt::print(stderr, "{}\n", status_line(tool_name, frames, stage));
        said->stage = stage;
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
    case ProgressFormat::none:
    case ProgressFormat::plain: break;
    }
    return fmt::format("{}: {}%", tool_name, percent);
}

std::string status_line(const std::string &tool_name, const FrameCount &frames, const std::string &stage) {
    const std::string frame =
        frames.number ? fmt::format("frame {} ({} of {}): ", *frames.number, frames.done + 1, frames.all)
                      : "";
    return fmt::format("openjd_status: {}: {}{}", tool_name, frame, stage);
}

std::string error_prefix(ProgressFormat format, const std::string &tool_name) {
    return (format == ProgressFormat::openjd ? "openjd_fail: " : "") + tool_name + ": ";
}

std::unique_ptr<Progress> progress_of(ProgressFormat format, const std::string &tool_name,
                                      FrameCount frames) {
    if (format == ProgressFormat::none) return std::make_unique<Progress>();
    return std::make_unique<Progress>(format == ProgressFormat::terminal
                                          ? terminal_listener(tool_name)
                                          : farm_listener(format, tool_name, frames));
}

} // namespace sparselens
