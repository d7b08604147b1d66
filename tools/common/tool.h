// What every executable shares: common options, exit codes, one clear line for an error.
#pragma once

#include "base/progress.h"

#include <CLI/CLI.hpp>

#include <functional>
#include <memory>
#include <string>

namespace sparselens {

struct ToolContext {
    int threads = 0;      // 0 = all the process may use
    bool verbose = false; // say on stderr what was found and done
    // A line on stderr when that is a terminal, else silence.
    std::unique_ptr<Progress> progress;

    // Printed to stderr with the tool's name in front, where --verbose asks for it.
    void say(const std::string &line) const;
    std::string tool_name;
};

// Adds --version, -v, --threads to `app`, parses, runs `job` and turns what happens into an exit code:
// 0 done, 1 failed (Error, memory, any exception), 2 wrong usage (CLI11's errors, UsageError).
int run_tool(CLI::App &app, int argc, char **argv, const std::function<void(const ToolContext &)> &job);

// A warning on stderr, always printed: "tool: warning: text".
void warn(const ToolContext &tool, const std::string &text);

} // namespace sparselens
