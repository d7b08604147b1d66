// What all tools share: common options, exit codes, and one clear line for an error.
#pragma once

#include "base/progress.h"
#include "chain/notices.h"
#include "harness/commands/cli.h"
#include "harness/in_turn.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace sparselens {

struct ToolContext {
    int threads = 0;                         // 0: all that the process may use
    bool verbose = false;                    // report on stderr what was found and done
    std::optional<std::uint64_t> max_memory; // bytes for reading a file; empty: by its size
    std::unique_ptr<Progress> progress;      // never null
    std::string stats;                       // the file of write_stats(); empty: none
    std::optional<int> frame;                // the number of the frame in a range
    bool keeps = false;                      // what it has for the next frame, see Job::keeps
    std::string command_line;                // see history.h

    // What warn_once() has said in this range of frames; never null.
    std::shared_ptr<std::set<std::string>> warned = std::make_shared<std::set<std::string>>();

    // Never null. A job may leave its last step here, which writes what it made and holds all that it needs: of a range of
    // frames, it runs while the next frame is at work, when those before have ended. It counts as part of the job.
    std::unique_ptr<std::function<void()>> last_step = std::make_unique<std::function<void()>>();

    // With --verbose, prints the line to stderr after the name of the tool.
    void say(const std::string &line) const;
    std::string tool_name;

    // Prints what the chain says, notes with --verbose alone.
    Tell tell() const;

    // All that it says is said in the turn of its frame; never null.
    std::shared_ptr<InTurn> turn = std::make_shared<InTurn>(true);
};

using Work = std::function<void(const ToolContext &)>;

// One frame's.
struct Job {
    Work work;
    // Names what the work keeps for the next frame if that names the same, which then begins after it; "": nothing. Frames of
    // different names may be worked on at the same time, on any thread, and leave what they write to their last steps.
    // Without this, all frames are worked on one after the other.
    std::function<std::string()> keeps = {};
};

// What the tool reads: only tools that read files have --max-memory.
enum class Reads { files, nothing };

// Adds --version, -v and --threads to `app`, parses the command line, does `work` and returns the exit code: 0 done,
// 1 failed (Error, memory, any exception), 2 usage error (the errors of CLI11, UsageError).
int run_tool(CLI::App &app, int argc, char **argv, const Work &work, Reads reads = Reads::files);
int run_tool(CLI::App &app, const std::vector<std::string> &words, const Work &work,
             Reads reads = Reads::files); // without the program

// The same for each frame of a range (frames.h), with --frames, --skip-bad-frames, -u, --progress and --stats.
// `prepare` adds the options of the tool to an app and returns the job that they describe; it is called again for every
// frame.
using Prepare = std::function<Job(CLI::App &)>;
int run_frames(const std::string &name, const std::string &description, int argc, char **argv,
               const Prepare &prepare);

// Prints a warning to stderr, with or without --verbose: "tool: warning: text".
void warn(const ToolContext &tool, const std::string &text);

// The same for the first frame of a range that has something of this kind to say, a word for each kind; of later frames
// only --verbose prints it. Not for last steps, which run beside the next frame.
void warn_once(const ToolContext &tool, const std::string &kind, const std::string &text);

} // namespace sparselens
