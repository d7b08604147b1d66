// Sets up the process of a tool before its job and reports after it.
#pragma once

#include "harness/progress_lines.h"
#include "harness/tool.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace sparselens {

struct ProcessOptions {
    int threads = 0; // 0: all that the affinity mask allows
    bool verbose = false;
    std::optional<std::uint64_t> max_memory;
};

// Adds --version, -v, --threads and --max-memory.
void add_process_options(CLI::App &app, ProcessOptions &options);

// Adds --progress.
void add_progress_option(CLI::App &app, ProgressFormat &format);

// The beginning of error messages, from words that are not parsed yet: a farm must understand errors in the words too.
std::string prefix_of(const std::string &name, const std::vector<std::string> &words);

// Parses the words. Returns nothing if there is work to do; else the exit code, after answering --help and the like or
// reporting a usage error. `prefix` begins the message: "dof-gather: ", "dof-gather: frame 12: ".
std::optional<int> parse_words(CLI::App &app, const std::vector<std::string> &words,
                               const std::string &prefix);

// Sets threads, memory limit and signal handlers.
void set_up_process(const ProcessOptions &options, const ToolContext &tool);

// The memory for frames held at the same time, in bytes: --max-memory, else a quarter of the machine's memory.
std::uint64_t memory_for_frames(const std::optional<std::uint64_t> &max_memory);

// Runs `work`, reports its exception in one line that begins with `prefix`, and returns the exit code.
int exit_code_of(const std::string &prefix, const std::function<void()> &work);

} // namespace sparselens
