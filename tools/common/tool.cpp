#include "common/tool.h"

#include "base/error.h"
#include "io/memory_limit.h"
#include "io/unfinished.h"

#include <ImfThreading.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <unistd.h>

#include <cctype>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

namespace sparselens {

namespace {

std::unique_ptr<Progress> terminal_progress(const std::string &tool_name) {
    if (!isatty(STDERR_FILENO)) return std::make_unique<Progress>();
    return std::make_unique<Progress>([tool_name](const std::string &stage, int percent) {
        std::fprintf(stderr, "\r%s: %s %3d%%%s", tool_name.c_str(), stage.c_str(), percent,
                     percent == 100 ? "\n" : "");
    });
}

// One line, whatever a library put into its message or a file into its names; no control character reaches the
// terminal.
std::string one_line(std::string text) {
    for (char &c : text)
        if (std::iscntrl(static_cast<unsigned char>(c))) c = ' ';
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
}

int fail(const std::string &tool_name, const std::string &text, int code) {
    std::fprintf(stderr, "%s: %s\n", tool_name.c_str(), one_line(text).c_str());
    return code;
}

// Told to stop: no half-written file is left, and the process dies of the signal as its parent expects.
extern "C" void stop(int number) {
    remove_unfinished();
    std::signal(number, SIG_DFL);
    std::raise(number);
}

void handle_signals() {
    std::signal(SIGPIPE, SIG_IGN); // a reader that went away is an error to report, not a silent death
    for (const int number : {SIGINT, SIGTERM, SIGHUP})
        if (std::signal(number, stop) == SIG_IGN) std::signal(number, SIG_IGN); // as under nohup
}

int run_job(const ToolContext &tool, const std::function<void(const ToolContext &)> &job) {
    try {
        job(tool);
        return 0;
    } catch (const UsageError &error) {
        return fail(tool.tool_name, error.what(), 2);
    } catch (const std::bad_alloc &) {
        return fail(tool.tool_name, "out of memory", 1);
    } catch (const std::exception &error) {
        return fail(tool.tool_name, error.what(), 1);
    }
}

} // namespace

void ToolContext::say(const std::string &line) const {
    if (verbose) std::fprintf(stderr, "%s: %s\n", tool_name.c_str(), line.c_str());
}

void warn(const ToolContext &tool, const std::string &text) {
    std::fprintf(stderr, "%s: warning: %s\n", tool.tool_name.c_str(), one_line(text).c_str());
}

int run_tool(CLI::App &app, int argc, char **argv, const std::function<void(const ToolContext &)> &job) {
    ToolContext tool;
    tool.tool_name = app.get_name();
    app.set_version_flag("--version", tool.tool_name + " (sparselens) " SPARSELENS_VERSION);
    app.add_flag("-v,--verbose", tool.verbose, "Say on stderr what was found and done");
    app.add_option("--threads", tool.threads, "Threads to use, 0 = all")
        ->type_name("N")
        ->check(CLI::Range(0, 4096));
    std::optional<std::uint64_t> max_memory;
    app.add_option("--max-memory", max_memory,
                   "Memory that reading a file may take, as 4GB (64 MB and 1100 times the file's size)")
        ->type_name("SIZE")
        ->transform(CLI::AsSizeValue(false));
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success &answer) { // --help, --version
        return app.exit(answer);
    } catch (const CLI::RequiredError &error) {
        // What was not understood says more than what is missing for it.
        const auto unknown = app.remaining();
        const std::string text = unknown.empty() ? error.what() : "unknown: " + unknown.front();
        return fail(tool.tool_name, text + " (see --help)", 2);
    } catch (const CLI::ParseError &error) {
        return fail(tool.tool_name, error.what() + std::string(" (see --help)"), 2);
    }
    const int threads = tool.threads > 0 ? tool.threads : tbb::info::default_concurrency();
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
    set_memory_limit(max_memory);
    Imf::setGlobalThreadCount(threads > 1 ? threads : 0);
    handle_signals();
    tool.progress = terminal_progress(tool.tool_name);
    return run_job(tool, job);
}

} // namespace sparselens
