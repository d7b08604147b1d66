#include "harness/tool.h"

#include "base/error.h"
#include "base/system/system.h"
#include "harness/commands/file_arguments.h"
#include "harness/history.h"
#include "harness/process.h"
#include "harness/progress_lines.h"
#include "io/display/shown_picture.h"
#include "io/exr/exr_flat.h"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace sparselens {

void ToolContext::say(const std::string &line) const {
    if (!verbose) return;
    fmt::print(stderr, "{}: {}\n", tool_name, with_options(line));
}

namespace {

std::string warning(const ToolContext &tool, const std::string &text) {
    return fmt::format("{}: warning: {}\n", tool.tool_name, one_line(with_options(text)));
}

} // namespace

void print(const std::string &text) {
    if (std::fputs(text.c_str(), stdout) == EOF || std::fflush(stdout) != 0)
        throw Error("standard output: cannot write");
}

void write_plain(const std::string &path, const Image &image) {
    if (is_shown_picture(path)) return write_shown_picture(path, image);
    write_flat_exr(path, image, {});
}

void warn(const ToolContext &tool, const std::string &text) { fmt::print(stderr, "{}", warning(tool, text)); }

Notify ToolContext::notify() const {
    return [this](const Notice &notice) {
        switch (level_of(notice)) {
        case NoticeLevel::note: say(words_of(notice)); break;
        case NoticeLevel::warning: warn(*this, words_of(notice)); break;
        case NoticeLevel::once: warn_once(*this, fmt::to_string(int(notice.kind)), words_of(notice)); break;
        }
    };
}

void warn_once(const ToolContext &tool, const std::string &kind, const std::string &text) {
    if (tool.warned->insert(kind).second)
        warn(tool, text);
    else
        tool.say(one_line(text));
}

int run_tool(CLI::App &app, int argc, char **argv, const Work &work) {
    return run_tool(app, {argv + 1, argv + argc}, work);
}

int run_tool(CLI::App &app, const std::vector<std::string> &words, const Work &work) {
    ProcessOptions options;
    add_process_options(app, options);
    const std::string prefix = prefix_of(app.get_name(), words);
    if (const auto code = parse_words(app, words, prefix)) return *code;
    ToolContext tool;
    tool.tool_name = app.get_name();
    tool.verbose = options.verbose;
    tool.max_memory = options.max_memory;
    tool.command_line = command_line(tool.tool_name, words);
    set_up_process(options, tool);
    tool.progress = progress_of(ProgressFormat::terminal, tool.tool_name, {});
    return exit_code_of(prefix, [&] {
        const NamedFiles files = named_files(app);
        refuse_overwriting({&files, 1});
        work(tool);
    });
}

void add_examples(CLI::App &app, std::initializer_list<Example> examples) {
    std::string text = "Examples:\n";
    for (const auto &[purpose, command] : examples)
        text += std::string("  ") + purpose + ":\n      " + command + "\n";
    app.footer(text);
#if CLI11_VERSION_MAJOR > 2 || CLI11_VERSION_MINOR >= 6
    app.get_formatter()->enable_footer_formatting(false); // the formatter would join lines
#endif
}

void write_stats(const ToolContext &tool, const Stats &fields) {
    if (tool.stats.empty()) return;
    Stats line{{"tool", tool.tool_name}};
    if (tool.frame) line["frame"] = *tool.frame;
    line.update(fields);
    for (const auto &[step, ms] : tool.progress->take_times())
        line["ms"][step] = std::round(ms * 1000) / 1000;
    const std::string text = line.dump() + '\n';
    const bool to_stderr = tool.stats == "-";
    const int file = to_stderr ? system::standard_error : system::open(tool.stats, system::Open::append);
    // One call, so that lines of stages that share the file do not mix.
    const bool written =
        file >= 0 && system::write(file, text.data(), text.size()) == std::ptrdiff_t(text.size());
    const int reason = errno;
    if (!to_stderr && file >= 0) system::close(file);
    if (!written) throw Error(tool.stats + ": cannot write: " + std::strerror(reason));
}

} // namespace sparselens
