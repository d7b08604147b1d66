// What all tools share: common options, exit codes, and one clear line for an error.
#pragma once

#include "base/image.h"
#include "base/progress.h"
#include "chain/notices.h"
#include "harness/commands/cli.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace sparselens {

struct ToolContext {
    bool verbose = false;                    // report on stderr what was found and done
    std::optional<std::uint64_t> max_memory; // bytes for reading a file; empty: set by its size
    std::unique_ptr<Progress> progress = std::make_unique<Progress>(); // never null
    std::string stats;        // the file for write_stats(); empty: none
    std::optional<int> frame; // the number of the frame in a range
    // The name that stands for `name`, a word of the command, `later` frames later, also beyond the range. A name of no
    // sequence stays the same. Never null.
    std::function<std::string(const std::string &name, int later)> other_frame = [](const std::string &name,
                                                                                    int) { return name; };
    bool keeps = false;       // holds something for the next frame, see Job::keeps
    std::string command_line; // see history.h

    // The kinds of warning that warn_once() has printed in this range of frames; never null.
    std::shared_ptr<std::set<std::string>> warned = std::make_shared<std::set<std::string>>();

    // With --verbose, prints the line to stderr after the name of the tool.
    void say(const std::string &line) const;
    std::string tool_name;

    // Returns a function that prints what the chain reports; notes only with --verbose.
    Notify notify() const;
};

using Work = std::function<void(const ToolContext &)>;

// The job of one frame.
struct Job {
    Work work;
    // Names what the work keeps for the next frame, if that names the same; "" means nothing.
    std::function<std::string()> keeps = {};
    // Whether it makes one output of the moments of a shutter, whose files one name with %s names. Other tools run once
    // for each moment (commands/each_picture.h).
    bool joins_moments = false;
};

// Adds --version, -v, --threads and --max-memory to `app`, parses the command line, does `work` and returns the exit code: 0 done,
// 1 failed (Error, memory, any exception), 2 usage error (the errors of CLI11, UsageError).
int run_tool(CLI::App &app, int argc, char **argv, const Work &work);
int run_tool(CLI::App &app, const std::vector<std::string> &words, const Work &work); // without the program

// Runs the tool for each frame of a range (frames.h), with --frames, --skip-bad-frames, --skip-existing, --progress and
// --stats. `prepare` adds the options of the tool to an app and returns the job that they describe; it is called again
// for every frame.
using Prepare = std::function<Job(CLI::App &)>;
int run_frames(const std::string &name, const std::string &description, int argc, char **argv,
               const Prepare &prepare);

// Prints to standard output. Throws Error if that fails.
void print(const std::string &text);

// Writes R, G and B as they are: EXR, or a format of the screen.
void write_plain(const std::string &path, const Image &image);

// Prints a warning to stderr, with or without --verbose: "tool: warning: text".
void warn(const ToolContext &tool, const std::string &text);

// Prints the warning for the first frame of a range that has one of this kind (a word); for later frames only with
// --verbose.
void warn_once(const ToolContext &tool, const std::string &kind, const std::string &text);

struct Example {
    const char *purpose; // a sentence without its full stop
    const char *command; // as typed, in one line
};

void add_examples(CLI::App &app, std::initializer_list<Example> examples);

// --stats: writes statistics on the work that a stage left out, as one line of JSON per stage and frame, so that the
// stages of a pipe can share a file. docs/stats.md explains the keys.
using Stats = nlohmann::ordered_json;

// Appends a line with the name of the tool, the frame if there are several, and `fields` to the file that --stats names
// (- for stderr). Does nothing without --stats. Throws Error if the file cannot be written.
void write_stats(const ToolContext &tool, const Stats &fields);

// Options whose values are words.

// Turns each word into the number of its value, which CLI11 reads into an enum or a bool. Everything else, even a
// number, is a usage error that lists the words.
template <typename Value>
CLI::Validator words(const std::map<std::string, Value> &values) {
    const auto look_up = [values](std::string &text) -> std::string {
        const auto found = values.find(text);
        if (found == values.end()) {
            std::vector<std::string> all;
            for (const auto &[word, value] : values) all.push_back(word);
            return fmt::format("must be one of {}, not '{}'", fmt::join(all, ", "), text);
        }
        text = fmt::to_string(static_cast<int>(found->second));
        return {};
    };
    return CLI::Validator(look_up, "");
}

} // namespace sparselens
