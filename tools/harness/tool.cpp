#include "harness/tool.h"

#include "harness/commands/named_files.h"
#include "harness/history.h"
#include "harness/one_line.h"
#include "harness/process.h"
#include "harness/progress_lines.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace sparselens {

void ToolContext::say(const std::string &line) const {
    if (verbose) fmt::print(stderr, "{}: {}\n", tool_name, with_options(line));
}

void warn(const ToolContext &tool, const std::string &text) {
    fmt::print(stderr, "{}: warning: {}\n", tool.tool_name, one_line(with_options(text)));
}

void warn_once(const ToolContext &tool, const std::string &kind, const std::string &text) {
    if (tool.warned->insert(kind).second)
        warn(tool, text);
    else
        tool.say(one_line(text));
}

int run_tool(CLI::App &app, int argc, char **argv, const Job &job, Reads reads) {
    return run_tool(app, {argv + 1, argv + argc}, job, reads);
}

int run_tool(CLI::App &app, const std::vector<std::string> &words, const Job &job, Reads reads) {
    ProcessOptions options;
    add_process_options(app, options);
    if (reads == Reads::files) add_memory_option(app, options);
    const std::string prefix = error_prefix(ProgressFormat::terminal, app.get_name());
    if (const auto code = parse_words(app, words, prefix)) return *code;
    ToolContext tool;
    tool.tool_name = app.get_name();
    tool.verbose = options.verbose;
    tool.threads = options.threads;
    tool.max_memory = options.max_memory;
    tool.command_line = command_line(tool.tool_name, words);
    const Process process(options, tool);
    tool.progress = progress_of(ProgressFormat::terminal, tool.tool_name, {});
    return exit_code_of(prefix, [&] {
        const NamedFiles files = named_files(app);
        refuse_overwriting({&files, 1});
        job(tool);
        if (*tool.last_step) (*tool.last_step)();
    });
}

} // namespace sparselens
