#include "base/error.h"
#include "harness/commands/each_picture.h"
#include "harness/commands/file_arguments.h"
#include "harness/commands/frames.h"
#include "harness/history.h"
#include "harness/process.h"
#include "harness/progress_lines.h"
#include "harness/tool.h"
#include "io/exr/exr_parts.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <set>
#include <system_error>
#include <utility>

namespace sparselens {

namespace {

struct FrameOptions {
    std::string frames; // read by FrameCommands
    std::string stats;
    bool skip_bad_frames = false, skip_existing = false;
    ProgressFormat progress = ProgressFormat::terminal;
};

void add_frame_options(CLI::App &app, FrameOptions &options) {
    app.add_option(
           "--frames", options.frames,
           "Frames to process, e.g. 1-100x2 or 1,3,5-9; file names may hold #### (also #: four digits) or "
           "%04d, and values may be keyed, e.g. 1:5.0,24:2.0")
        ->type_name("RANGE")
        ->group("Frames");
    app.add_flag("--skip-bad-frames", options.skip_bad_frames,
                 "Continue after a frame that fails, and exit with code 1 at the end")
        ->group("Frames");
    app.add_flag("--skip-existing", options.skip_existing, "Skip frames whose outputs exist")
        ->group("Frames");
    app.add_option("--stats", options.stats,
                   "File to which statistics are appended, one line of JSON per frame; - for stderr")
        ->type_name("FILE");
    add_progress_option(app, options.progress);
}

void explain_all_pictures(CLI::App &app) {
    for (const EachPicture *each : {&each_view(), &each_layer()}) {
        CLI::Option *option = app.get_option_no_throw(each->option);
        if (!option) continue;
        std::string text = option->get_description();
        text.insert(text.rfind(" (default"),
                    fmt::format("; all: one run for each {}; its name replaces {} in file names", each->noun,
                                each->placeholder));
        option->description(text);
    }
}

// The parsed command line of the tool at one frame.
struct FrameCommand {
    CLI::App app;
    FrameOptions frames;
    ProcessOptions process;
    Job job;

    FrameCommand(const std::string &name, const std::string &description, const Prepare &prepare)
        : app(description, name) {
        job = prepare(app);
        add_frame_options(app, frames);
        add_process_options(app, process);
        explain_all_pictures(app);
    }
};

using CommandPtr = std::unique_ptr<FrameCommand>;

std::string frame_name(const FrameCommands &commands, std::size_t i) {
    return commands.is_range() ? fmt::format("frame {}: ", commands.number(i)) : "";
}

// Whether the outputs of the frame are there, none of which holds all frames.
bool has_outputs(const FrameCommand &command, const ToolContext &tool) {
    const std::vector<NamedFile> outputs = named_files(command.app).outputs;
    if (outputs.empty()) return false;
    std::error_code unknown;
    for (const auto &[option, path] : outputs)
        if (!std::filesystem::is_regular_file(path, unknown) || holds_all_frames(path)) return false;
    tool.say(outputs.front().path + " exists");
    return true;
}

// Prints a stage for a farm.
void say_stage(ProgressFormat format, const ToolContext &tool, const char *stage) {
    if (format == ProgressFormat::terminal) return;
    tool.progress->start(stage, 1);
    tool.progress->advance();
}

ToolContext context_of(const std::string &name, const FrameCommand &command) {
    ToolContext tool;
    tool.tool_name = name;
    tool.verbose = command.process.verbose;
    tool.max_memory = command.process.max_memory;
    tool.stats = command.frames.stats;
    return tool;
}

// Runs all frames of one command line.
int run_words(const std::string &name, const std::string &description, const std::vector<std::string> &words,
              const Prepare &prepare) {
    const std::string prefix = prefix_of(name, words);
    std::optional<FrameCommands> commands;
    int code = exit_code_of(prefix, [&] { commands.emplace(words); });
    if (code != 0) return code;
    const std::size_t count = commands->size();
    const auto parse = [&](std::size_t i, CommandPtr &command) {
        command = std::make_unique<FrameCommand>(name, description, prepare);
        return parse_words(command->app, commands->words(i), prefix + frame_name(*commands, i));
    };
    // Usage errors of any frame are reported before work on the first frame begins.
    CommandPtr first, other;
    std::vector<NamedFiles> files;
    std::vector<std::string> keeps; // what each frame keeps for the next
    for (std::size_t i = 0; i < count; ++i) {
        CommandPtr &parsed = i == 0 ? first : other;
        if (const auto answered = parse(i, parsed)) return *answered;
        files.push_back(named_files(parsed->app));
        keeps.push_back(parsed->job.keeps ? parsed->job.keeps() : "");
    }
    code = exit_code_of(prefix, [&] { refuse_overwriting(files); });
    if (code != 0) return code;
    for (const std::string &text : commands->warnings()) warn(context_of(name, *first), text);

    const ProgressFormat format = first->frames.progress;
    set_up_process(first->process, context_of(name, *first));
    const auto warned = std::make_shared<std::set<std::string>>();
    int worst = 0;
    for (std::size_t i = 0; i < count; ++i) {
        CommandPtr command;
        parse(i, command);
        ToolContext tool = context_of(name, *command);
        if (commands->is_range()) tool.frame = commands->number(i);
        tool.other_frame = [&commands, i](const std::string &word, int later) {
            return commands->other_frame(i, word, later);
        };
        tool.keeps = i + 1 < count && !keeps[i].empty() && keeps[i] == keeps[i + 1];
        tool.warned = warned;
        tool.command_line = command_line(name, commands->words(i));
        tool.progress = progress_of(format, name, {i, count, tool.frame});
        code = exit_code_of(prefix + frame_name(*commands, i), [&] {
            if (!command->frames.skip_existing || !has_outputs(*command, tool)) command->job.work(tool);
            say_stage(format, tool, "done");
        });
        worst = std::max(worst, code);
        if (code != 0 && !(code == 1 && first->frames.skip_bad_frames)) break;
    }
    return worst;
}

// The names of the views or layers in the first input of the command.
std::vector<std::string> pictures_of_input(const EachPicture &each, const CLI::App &parsed) {
    const std::vector<NamedFile> inputs = named_files(parsed).inputs;
    const auto input = std::ranges::find_if(
        inputs, [](const NamedFile &file) { return file.option == "IN" || file.option == "views"; });
    if (input == inputs.end() || input->path == "-")
        throw UsageError(fmt::format("{} all needs the name of the input, because it reads it once per {}",
                                     each.option, each.noun));
    const CLI::Option *view = parsed.get_option_no_throw(each_view().option);
    const std::string of_view = view && view->count() > 0 ? view->as<std::string>() : std::string();
    const std::vector<std::string> names =
        &each == &each_view() ? stereo_views(input->path) : picture_layers(input->path, of_view);
    if (names.empty())
        throw Error(input->path +
                    (&each == &each_view() ? ": it names no stereo views"
                                           : ": it has one picture, outside of all layers") +
                    "; leave out " + each.option + " all");
    return names;
}

// Expands a command line that asks for all views, layers or moments into one command for each. `answered` is the exit
// code if
// --help or the like, or an error in the words, ended it.
struct EachCommand {
    std::vector<std::vector<std::string>> commands;
    std::optional<int> answered = {};

    void expand(const EachPicture &each, const std::string &name, const std::string &description,
                const Prepare &prepare) {
        std::vector<std::vector<std::string>> expanded;
        for (const std::vector<std::string> &words : commands) {
            if (!asks_for_all(each, words)) {
                expanded.push_back(words);
                continue;
            }
            FrameCommand first(name, description, prepare);
            answered = parse_words(first.app, FrameCommands(words).words(0), prefix_of(name, words));
            if (answered) return;
            for (const std::string &picture : pictures_of_input(each, first.app))
                expanded.push_back(words_for_one(each, words, picture));
        }
        commands = std::move(expanded);
    }

    // `joined`: the tool makes one output of all moments.
    void expand_moments(bool joined) {
        std::vector<std::vector<std::string>> expanded;
        for (const std::vector<std::string> &words : commands)
            if (asks_for_each_moment(words))
                std::ranges::move(words_for_moments(words), std::back_inserter(expanded));
            else {
                if (!joined) refuse_moments(words);
                expanded.push_back(words);
            }
        commands = std::move(expanded);
    }
};

} // namespace

int run_frames(const std::string &name, const std::string &description, int argc, char **argv,
               const Prepare &prepare) {
    const std::vector<std::string> words(argv + 1, argv + argc);
    EachCommand all{{words}};
    int worst = exit_code_of(prefix_of(name, words), [&] {
        for (const EachPicture *each : {&each_view(), &each_layer()})
            if (!all.answered) all.expand(*each, name, description, prepare);
        if (!all.answered) all.expand_moments(FrameCommand(name, description, prepare).job.joins_moments);
    });
    if (all.answered) return *all.answered;
    if (worst != 0) return worst;
    for (const auto &command : all.commands)
        worst = std::max(worst, run_words(name, description, command, prepare));
    return worst;
}

} // namespace sparselens
