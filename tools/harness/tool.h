// What every executable shares: common options, exit codes, one clear line for an error.
#pragma once

#include "base/progress.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace sparselens {

struct ToolContext {
    int threads = 0;                         // 0 = all the process may use
    bool verbose = false;                    // say on stderr what was found and done
    std::optional<std::uint64_t> max_memory; // that reading a file may take, bytes; empty: by its size
    std::unique_ptr<Progress> progress;      // never null
    std::string stats;                       // where write_stats() writes; empty: nowhere
    std::optional<int> frame;                // of a range
    std::string command_line;                // what it was asked to do, see history.h

    // Printed to stderr with the tool's name in front, where --verbose asks for it.
    void say(const std::string &line) const;
    std::string tool_name;
};

using Job = std::function<void(const ToolContext &)>;

// What the tool reads: --max-memory, which limits it, is for those alone that read files.
enum class Reads { files, nothing };

// Adds --version, -v, --threads to `app`, parses, runs `job` and turns what happens into an exit code:
// 0 done, 1 failed (Error, memory, any exception), 2 wrong usage (CLI11's errors, UsageError).
int run_tool(CLI::App &app, int argc, char **argv, const Job &job, Reads reads = Reads::files);

// The same for each frame of a range (frames.h), with --frames, --skip-bad-frames, -u, --progress and
// --stats. `prepare` adds the tool's options to an app and returns what does the work they ask for; it is
// called anew for every frame.
using Prepare = std::function<Job(CLI::App &)>;
int run_frames(const std::string &name, const std::string &description, int argc, char **argv,
               const Prepare &prepare);

// A warning on stderr, always printed: "tool: warning: text".
void warn(const ToolContext &tool, const std::string &text);

} // namespace sparselens
